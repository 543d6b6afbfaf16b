#pragma once

// The version of Alhazen, and the namespace of what these headers declare. CMake reads the three numbers from here.

#define ALHAZEN_VERSION_MAJOR 0
#define ALHAZEN_VERSION_MINOR 1
#define ALHAZEN_VERSION_PATCH 0

/// For comparisons: `#if ALHAZEN_VERSION_NUMBER >= 1002003` holds for 1.2.3 and later.
#define ALHAZEN_VERSION_NUMBER (ALHAZEN_VERSION_MAJOR * 1000000 + ALHAZEN_VERSION_MINOR * 1000 + ALHAZEN_VERSION_PATCH)

/// "0.1.0": of the headers that a program is compiled with; version() returns that of the library that it runs with.
#define ALHAZEN_VERSION_STRING \
  ALHAZEN_TEXT_OF_VERSION(ALHAZEN_VERSION_MAJOR, ALHAZEN_VERSION_MINOR, ALHAZEN_VERSION_PATCH)

/// What public headers open: names are alhazen::NAME in source code, and have the version, v0_1, for the linker.
#define ALHAZEN_NAMESPACE alhazen::inline ALHAZEN_ABI_NAMESPACE
#define ALHAZEN_ABI_NAMESPACE ALHAZEN_NAME_OF_VERSION(ALHAZEN_VERSION_MAJOR, ALHAZEN_VERSION_MINOR)

// The arguments are expanded before the second of each pair joins them.
#define ALHAZEN_TEXT_OF_VERSION(major, minor, patch) ALHAZEN_JOIN_TEXT(major, minor, patch)
#define ALHAZEN_JOIN_TEXT(major, minor, patch) #major "." #minor "." #patch
#define ALHAZEN_NAME_OF_VERSION(major, minor) ALHAZEN_JOIN_NAME(major, minor)
#define ALHAZEN_JOIN_NAME(major, minor) v##major##_##minor
