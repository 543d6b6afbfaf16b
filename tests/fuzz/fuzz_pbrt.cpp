// Reads any bytes as a scene text. Almost all of them must give errors; a scene that the reader returns must be
// consistent.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/pbrt/pbrt.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void require_sound(const alhazen::impl::Scene& scene) {
  for (const alhazen::impl::Mesh& mesh : scene.meshes) {
    require(mesh.indices.size() % 3 == 0);
    for (const uint32_t index : mesh.indices) require(index < mesh.positions.size());
    for (const alhazen::impl::Vec3d& position : mesh.positions) require(is_finite(position));
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  }
  for (const alhazen::impl::ShapeGroup& group : scene.groups) {
    for (const alhazen::impl::Shape& shape : group.shapes) {
      require(shape.material < scene.materials.size());
      require(shape.type == alhazen::impl::ShapeType::mesh ? shape.mesh < scene.meshes.size() : shape.radius > 0);
    }
  }
  for (const alhazen::impl::Texture& texture : scene.textures)
    for (const uint32_t input : texture.inputs)
      require(input == alhazen::impl::no_index || input < scene.textures.size());
  for (const alhazen::impl::Instance& instance : scene.instances) require(instance.group < scene.groups.size());
  for (const alhazen::impl::Light& light : scene.lights)
    require(is_finite(light.radiance) && is_finite(light.position));
  require(scene.film.width > 0 && scene.film.height > 0 && scene.samples_per_pixel > 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  // Without slashes and in a folder that does not exist, no name refers to a file.
  std::replace(text.begin(), text.end(), '/', '_');
  alhazen::impl::Diagnostics diagnostics;
  try {
    require_sound(alhazen::impl::parse_pbrt(text, "fuzz.pbrt", "/no-such-folder", diagnostics));
  } catch (const alhazen::impl::InputError&) {
  }
  return 0;
}
