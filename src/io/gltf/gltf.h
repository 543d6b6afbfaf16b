#pragma once

// glTF 2.0: .gltf with the files it refers to, and .glb.

#include <cstdint>
#include <span>
#include <string>

#include "files/input_file.h"
#include "io/read_options.h"
#include "scene/scene.h"

namespace alhazen {

/// Reads the default scene of a file. Throws InputError.
Scene read_gltf(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics);

/// The same for bytes in memory; `path` is for messages and confinement; files are relative to `folder`.
Scene parse_gltf(std::span<const uint8_t> bytes, const InputPath& path, const std::string& folder,
                 const ReadOptions& options, Diagnostics& diagnostics);

/// The names among which ReadOptions choose.
SceneListing list_gltf(const InputPath& path, Diagnostics& diagnostics, const FileSearch& search = {});

/// Returns whether the bytes begin a .glb file.
bool is_glb(std::span<const uint8_t> bytes);

}  // namespace alhazen
