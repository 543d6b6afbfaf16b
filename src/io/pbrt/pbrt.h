#pragma once

// Scenes in the format of pbrt-v4.

#include <string>

#include "files/input_file.h"
#include "io/find_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads a scene file and all that it includes. Paths in it are relative to the folder of the top file. Features of
/// pbrt-v4 that are not supported are replaced, with one warning each; anything unknown, ill-typed or malformed throws
/// InputError with `file:line:column` and an excerpt.
Scene read_pbrt(const InputPath& path, Diagnostics& diagnostics, const FileSearch& search = {});

/// The same for a text in memory. `name` replaces the file in messages; includes are looked up in `folder`.
Scene parse_pbrt(const std::string& text, const std::string& name, const std::string& folder, Diagnostics& diagnostics,
                 const FileSearch& search = {});
/// The same in the working folder; the files that the text names are opened in `scope`.
Scene parse_pbrt(const std::string& text, const std::string& name, const InputScope& scope, Diagnostics& diagnostics,
                 const FileSearch& search = {});

}  // namespace alhazen::impl
