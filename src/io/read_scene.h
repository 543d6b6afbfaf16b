#pragma once

// The one door for scene files: the reader is chosen by the name's extension.

#include <string>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen {

/// Reads a scene (.pbrt, .pbrt.gz, .gltf, .glb), or a mesh alone (.ply, .ply.gz), which is given a camera and a sky to
/// be seen by. Throws InputError, also where `options` choose what the format does not offer.
Scene read_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
inline Scene read_scene(const std::string& path, Diagnostics& diagnostics) { return read_scene(path, {}, diagnostics); }

/// What `options` may choose from. Throws InputError.
SceneListing list_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);

/// `path` for reading: bound to the folder of the scene file `scene` where `confine` says so, else as it is.
InputPath path_beside(const std::string& scene, const std::string& path, bool confine);

}  // namespace alhazen
