#pragma once

// The identity of a module. It is in a section of the file, so that it can be read without running any code of the
// module.

#include <cstdint>

namespace alhazen::impl {

inline constexpr char module_section[] = ".alhazen";
inline constexpr char module_magic[] = "Alhazen module";

struct ModuleIdentity {
  char magic[16] = {};
  char name[32] = {};
  char version[16] = {};
  char interface[32] = {};  ///< hash of the headers and compiler that it was built with (cmake/InterfaceHash.cmake)
};

}  // namespace alhazen::impl
