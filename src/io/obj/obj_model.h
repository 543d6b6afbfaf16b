#pragma once

// Wavefront OBJ files with their materials, as models.

#include <string>

#include "files/input_file.h"
#include "io/find_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads a file and the MTL files that it names, for an image of that aspect ratio (0: that of the film). Materials and
/// images that are missing, also in the folders of `search`, give one warning each. Throws InputError with line and
/// column, also for a missing image if `search` is strict.
Scene read_obj_model(const InputPath& path, double aspect, Diagnostics& diagnostics, const FileSearch& search = {});

/// The same for a text in memory. `name` replaces the file in messages; files are looked up in its folder.
Scene parse_obj_model(std::string_view text, const std::string& name, Diagnostics& diagnostics);

}  // namespace alhazen::impl
