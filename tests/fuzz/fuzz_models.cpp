// Reads any bytes as OBJ, MTL and STL files: gives consistent meshes, or an InputError.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/obj/mtl.h"
#include "io/obj/obj_file.h"
#include "io/stl/stl.h"

namespace {

void check(const alhazen::impl::Mesh& mesh) {
  const size_t vertices = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0) std::abort();
  for (const uint32_t index : mesh.indices)
    if (index >= vertices) std::abort();
  for (const size_t count : {mesh.normals.size(), mesh.uvs.size(), mesh.colours.size()})
    if (count != 0 && count != vertices) std::abort();
}

template <class Read>
void guarded(const Read& read) {
  try {
    read();
  } catch (const alhazen::impl::InputError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  for (const obj::Division division : {obj::Division::none, obj::Division::named})
    guarded([&] {
      MemorySource source(bytes);
      for (const obj::Part& part : obj::parse_obj(source, "fuzz.obj", division, diagnostics).parts) {
        check(part.mesh);
        if (part.points.size() != part.mesh.positions.size()) std::abort();
      }
    });
  guarded([&] {
    MemorySource source(bytes);
    obj::parse_mtl(source, "fuzz.mtl", diagnostics);
  });
  guarded([&] { check(parse_stl(bytes, "fuzz.stl", diagnostics)); });
  return 0;
}
