#pragma once

// The single entry point for scene files: it selects the reader by the name's extension, and where that is unknown by
// the first bytes of the file.

#include <string>
#include <vector>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// This name stands for a pbrt scene on standard input. Names in it are relative to the working folder.
inline constexpr const char* standard_input_name = "-";

/// Reads a scene (.pbrt, .gltf, .glb, .xml), or a model (.obj, .ply, .stl), to which it adds a camera and neutral
/// light. All but glTF may be compressed by gzip (.gz). Throws InputError, also if `options` select something that the
/// format does not offer.
Scene read_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
inline Scene read_scene(const std::string& path, Diagnostics& diagnostics) { return read_scene(path, {}, diagnostics); }

/// The cameras at `times`, in seconds, of a scene whose animation moves its camera alone, so that the rest need be read
/// once; empty for any other scene. Throws InputError.
std::vector<Camera> read_camera_path(const std::string& path, const ReadOptions& options,
                                     const std::vector<double>& times);
/// Whether the file is glTF, the only format that offers choices. Throws InputError if it is none that is read.
bool offers_choices(const std::string& path, const ReadOptions& options);

/// The choices for `options`. Throws InputError.
SceneListing list_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);

/// `path` for reading: confined to the folder of the scene file `scene` if `confine`, else as it is.
InputPath path_beside(const std::string& scene, const std::string& path, bool confine);

}  // namespace alhazen::impl
