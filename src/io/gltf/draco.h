#pragma once

// KHR_draco_mesh_compression, by the Draco library.

#include <map>
#include <string>

#include "io/gltf/accessors.h"

namespace alhazen::gltf {

/// A decompressed primitive: indices of triangles, and the values of the attributes by glTF's names.
struct DracoMesh {
  std::vector<uint32_t> indices;
  size_t vertex_count = 0;
  std::map<std::string, Values> attributes;
};

/// `compression` is the extension's object within `primitive`. Throws InputError, also where the program was built
/// without Draco.
DracoMesh decode_draco(const Document& document, Buffers& buffers, const Json& primitive, const Json& compression);

}  // namespace alhazen::gltf
