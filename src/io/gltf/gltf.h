#pragma once

// glTF 2.0: .gltf with the files it refers to, and .glb.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Reads the default scene of a file. Throws InputError.
Scene read_gltf(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics);

/// The same for bytes in memory; `path` is for messages and confinement; files are relative to `folder`.
Scene parse_gltf(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder,
                 const ReadOptions& options, Diagnostics& diagnostics);

/// The cameras at `times`, in seconds, of a file whose animation moves its camera alone; empty for any other file. Only
/// what places the camera is read.
std::vector<Camera> read_gltf_camera_path(const InputPath& path, const ReadOptions& options,
                                          const std::vector<double>& times);

/// The names among which ReadOptions choose.
SceneListing list_gltf(const InputPath& path, Diagnostics& diagnostics, const FileSearch& search = {});

/// Returns whether the bytes begin a .glb file.
bool is_glb(std::span<const uint8_t> bytes);

}  // namespace alhazen::impl
