#include <algorithm>
#include <array>
#include <string_view>

#include "io/gltf/document.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

constexpr std::array<std::string_view, 27> known_extensions{
    "KHR_lights_punctual",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_ior",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_emissive_strength",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_unlit",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_animation_pointer",
    "KHR_node_visibility",
    "KHR_materials_variants",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_draco_mesh_compression",
    "EXT_mesh_gpu_instancing",
    // Reported only for a texture that has no other image.
    "EXT_texture_webp",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "EXT_texture_avif",
};

/// Extensions that do not affect the image.
constexpr std::array<std::string_view, 9> metadata_extensions{
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_implicit_shapes",
};

template <size_t count>
bool contains(const std::array<std::string_view, count>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::string& name_of(const Document& document, const Json& value) {
  if (value.kind != JsonKind::string) document.fail(value, "the names of extensions must be strings");
  return value.string;
}

}  // namespace

void check_extensions(const Document& document) {
  const auto is_known = [](const std::string& name) {
    return contains(known_extensions, name) || contains(metadata_extensions, name);
  };
  for (const Json& value : document.array("extensionsRequired"))
    if (const std::string& name = name_of(document, value); !is_known(name))
      document.fail(value,
                    "the file requires the extension " + quoted(name) + ", which is not supported: export it without");
  for (const Json& value : document.array("extensionsUsed"))
    if (const std::string& name = name_of(document, value); !is_known(name))
      document.warn(value, "the extension " + quoted(name) + " is not supported and has no effect");
}

}  // namespace alhazen::impl::gltf
