#pragma once

// The one door for scene files: the reader is chosen by the name's extension.

#include <string>

#include "scene/scene.h"

namespace alhazen {

/// Reads a scene (.pbrt, .pbrt.gz), or a mesh alone (.ply, .ply.gz), which is given a camera and a sky to be seen by.
/// Throws InputError.
Scene read_scene(const std::string& path, Diagnostics& diagnostics);

}  // namespace alhazen
