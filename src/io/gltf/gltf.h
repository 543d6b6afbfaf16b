#pragma once

// glTF 2.0: .gltf with the files it names, and .glb.

#include <cstdint>
#include <span>
#include <string>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen {

/// Reads the default scene of a file. Throws InputError.
Scene read_gltf(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics);

/// The same of bytes in memory; `path` is for messages and for what confines the files, which are relative to `folder`.
Scene parse_gltf(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder,
                 const ReadOptions& options, Diagnostics& diagnostics);

/// Names of what ReadOptions choose from.
SceneListing list_gltf(const InputPath& path, Diagnostics& diagnostics);

/// Whether bytes begin a .glb file.
bool is_glb(std::span<const uint8_t> bytes);

}  // namespace alhazen
