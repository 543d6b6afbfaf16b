#include "io/gltf/validate_extensions.h"

#include <string>

namespace alhazen::impl::gltf {

namespace {

size_t size_of_list(const Document& d, const char* extension, const char* name) {
  const Json* object = d.extension(d.root(), extension);
  const Json* list = object == nullptr ? nullptr : d.list(*object, name);
  return list == nullptr ? 0 : list->items.size();
}

void check_below(const Document& d, const Json& at, uint64_t index, size_t size, const char* what) {
  if (index >= size)
    d.fail(at, "index out of range: \"" + std::string(what) + "\" has " + std::to_string(size) + " items");
}

void check_texture(const Document& d, const Json& texture) {
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"})
    if (const Json* extension = d.extension(texture, name)) d.index(*extension, "source", "images");
}

void check_node(const Document& d, const Json& node, size_t lights) {
  if (const Json* light = d.extension(node, "KHR_lights_punctual"))
    check_below(d, *light, d.required_whole(*light, "light"), lights, "lights");
  const Json* instancing = d.extension(node, "EXT_mesh_gpu_instancing");
  const Json* attributes = instancing == nullptr ? nullptr : d.object(*instancing, "attributes");
  if (attributes != nullptr)
    for (const Json& accessor : attributes->items) d.as_index(accessor, "accessors");
}

void check_primitive(const Document& d, const Json& primitive, size_t variants) {
  if (const Json* draco = d.extension(primitive, "KHR_draco_mesh_compression"))
    d.required_index(*draco, "bufferView", "bufferViews");
  const Json* extension = d.extension(primitive, "KHR_materials_variants");
  const Json* mappings = extension == nullptr ? nullptr : d.list(*extension, "mappings");
  if (mappings == nullptr) return;
  for (const Json& mapping : mappings->items) {
    if (mapping.kind != JsonKind::object) d.fail(mapping, "every item of \"mappings\" must be an object");
    d.index(mapping, "material", "materials");
    const Json* list = d.list(mapping, "variants");
    if (list == nullptr) continue;
    for (const Json& variant : list->items)
      if (variant.kind != JsonKind::number || !(variant.number >= 0 && variant.number < static_cast<double>(variants)))
        d.fail(variant, "index out of range: \"variants\" has " + std::to_string(variants) + " items");
  }
}

}  // namespace

void validate_extensions(const Document& d) {
  const size_t lights = size_of_list(d, "KHR_lights_punctual", "lights"),
               variants = size_of_list(d, "KHR_materials_variants", "variants");
  for (const Json& texture : d.array("textures")) check_texture(d, texture);
  for (const Json& node : d.array("nodes")) check_node(d, node, lights);
  for (const Json& mesh : d.array("meshes"))
    if (const Json* primitives = d.list(mesh, "primitives"))
      for (const Json& primitive : primitives->items) check_primitive(d, primitive, variants);
}

}  // namespace alhazen::impl::gltf
