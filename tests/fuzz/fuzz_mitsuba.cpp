// Reads any text as a Mitsuba scene: gives a scene, or an InputError.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/mitsuba/mitsuba.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  Diagnostics diagnostics;
  try {
    const Scene scene = parse_mitsuba(std::string(reinterpret_cast<const char*>(data), size), "fuzz.xml",
                                      "/no/such/folder", {}, diagnostics);
    for (const ShapeGroup& group : scene.groups)
      for (const Shape& shape : group.shapes) {
        if (shape.material >= scene.materials.size()) std::abort();
        if (shape.type == ShapeType::mesh && shape.mesh >= scene.meshes.size()) std::abort();
      }
    for (const Instance& instance : scene.instances)
      if (instance.group == 0 || instance.group >= scene.groups.size()) std::abort();
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
