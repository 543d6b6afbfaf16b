#pragma once

// KHR_draco_mesh_compression, by the Draco library.

#include <map>
#include <string>

#include "io/gltf/accessors.h"

namespace alhazen::impl::gltf {

/// A decompressed primitive: triangle indices, and the values of the attributes by their glTF names.
struct DracoMesh {
  std::vector<uint32_t> indices;
  size_t vertex_count = 0;
  std::map<std::string, Values> attributes;
};

/// `compression` is the extension's object in `primitive`. Throws InputError, also if the program was built without
/// Draco.
DracoMesh decode_draco(const Document& document, Buffers& buffers, const Json& primitive, const Json& compression);

}  // namespace alhazen::impl::gltf
