// Reads any bytes as a PLY file: gives a consistent mesh, or an InputError.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/ply/parse_ply.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  MemorySource source(std::string_view(reinterpret_cast<const char*>(data), size));
  Diagnostics diagnostics;
  try {
    const Mesh mesh = parse_ply(source, "fuzz.ply", diagnostics);
    const size_t vertices = mesh.positions.size();
    if (mesh.indices.size() % 3 != 0) std::abort();
    for (const uint32_t index : mesh.indices)
      if (index >= vertices) std::abort();
    if (!mesh.normals.empty() && mesh.normals.size() != vertices) std::abort();
    if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) std::abort();
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
