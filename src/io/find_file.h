#pragma once

// Finds the files that a scene names: in the scene's folder, then in further ones (`--search-path`).

#include <string>
#include <vector>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Where the files of a scene are looked for, and what becomes of texture images that are nowhere.
struct FileSearch {
  std::vector<std::string> folders;  ///< in this order, after the scene's own
  bool strict = false;               ///< such an image is an error; otherwise a warning, and magenta replaces it
};

struct FoundFile {
  InputPath path;        ///< where the file is; if it is nowhere, where it would be in the scene's folder
  InputProblem problem;  ///< why that cannot be read; no message if it can
};

/// Looks for file `name` of a scene in `folder`, the scene's. In each folder of `search` it looks for the path that the
/// scene gives, if that leads downwards, and then for its last part alone: scenes name files by folders of the machine
/// that they were made on. The scope holds everywhere.
FoundFile find_file(const std::string& folder, const std::string& name, const InputScope& scope,
                    const FileSearch& search);

/// Throws InputError if a folder of `search` does not exist or is outside the scope.
void check_search_folders(const FileSearch& search, const InputScope& scope);

/// The end of a message about a file that is nowhere: where else one may look for it.
std::string search_hint(const FileSearch& search);

/// What is seen in place of an image that is nowhere: linear sRGB.
inline constexpr Vec3d missing_colour{1, 0, 1};

/// An image of one texel of that colour. `name` is that of the file.
ImageTexels missing_image(const std::string& name);

}  // namespace alhazen::impl
