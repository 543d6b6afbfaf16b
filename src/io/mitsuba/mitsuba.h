#pragma once

// Scenes in the XML format of Mitsuba 3, and of Mitsuba 2 and 0.6 where it is the same.

#include <string>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads a scene file and all that it includes, with the meaning of Mitsuba's RGB variants. Features of Mitsuba that
/// are not supported are replaced, with one warning each; anything unknown, ill-typed or malformed throws InputError
/// with `file:line:column` of the element and an excerpt.
Scene read_mitsuba(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics);

/// The same for a text in memory. `name` replaces the file in messages; files are looked up in `folder`.
Scene parse_mitsuba(const std::string& text, const std::string& name, const std::string& folder,
                    const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen::impl
