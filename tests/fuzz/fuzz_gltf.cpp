// Reads any bytes as a glTF file: gives a consistent scene, or an InputError.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "io/gltf/gltf.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void require_sound(const alhazen::impl::Scene& scene) {
  for (const alhazen::impl::Mesh& mesh : scene.meshes) {
    require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0);
    for (const uint32_t index : mesh.indices) require(index < mesh.positions.size());
    for (const size_t size :
         {mesh.normals.size(), mesh.uvs.size(), mesh.second_uvs.size(), mesh.tangents.size(), mesh.colours.size()})
      require(size == 0 || size == mesh.positions.size());
  }
  for (const alhazen::impl::ShapeGroup& group : scene.groups)
    for (const alhazen::impl::Shape& shape : group.shapes)
      require(shape.material < scene.materials.size() && shape.mesh < scene.meshes.size());
  for (const alhazen::impl::Texture& texture : scene.textures) {
    for (const uint32_t input : texture.inputs)
      require(input == alhazen::impl::no_index || input < scene.textures.size());
    require(texture.kind != alhazen::impl::TextureKind::image || texture.image < scene.images.size());
  }
  for (const alhazen::impl::Instance& instance : scene.instances) require(instance.group < scene.groups.size());
  for (const alhazen::impl::Light& light : scene.lights)
    require(is_finite(light.radiance) && is_finite(light.position));
  require(scene.film.width > 0 && scene.film.height > 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alhazen::impl::Diagnostics diagnostics;
  alhazen::impl::ReadOptions options;
  // The last byte selects options, so that animations are tested too.
  if (size > 0 && data[size - 1] % 2 == 1) options.time = 0.3;
  try {
    require_sound(alhazen::impl::parse_gltf({data, size}, "fuzz.gltf", "/no-such-folder", options, diagnostics));
  } catch (const alhazen::impl::InputError&) {
  }
  return 0;
}
