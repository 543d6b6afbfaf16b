#include "compile/update_materials.h"

#include <algorithm>
#include <cstring>

#include "compile/materials.h"
#include "compile/scene_arrays.h"
#include "core/materials/material_list.h"
#include "scene/mixes.h"

namespace alhazen::impl {

namespace {

bool are_same(const TextureRange& a, const TextureRange& b) { return a.first == b.first && a.count == b.count; }

/// Whether lights have the same textures, with the same mappings and images: they are chosen by the mean of these.
template <class Real>
bool have_same_emission(const CompiledMaterials& before, const CompiledMaterials& now, const SceneArrays<Real>& fresh,
                        const SceneView<Real>& view) {
  if (before.emission.size() != now.emission.size()) return false;
  const auto are_equal = [](const auto& array, const auto* records, uint32_t count) {
    return array.size() == count && (count == 0 || std::memcmp(array.data(), records, count * sizeof(array[0])) == 0);
  };
  if (std::any_of(now.emission.begin(), now.emission.end(),
                  [](const TextureRange& range) { return range.count > 0; }) &&
      !(are_equal(fresh.texture_mappings, view.texture_mappings, view.texture_mappings_count) &&
        are_equal(fresh.images, view.images, view.images_count)))
    return false;
  for (size_t i = 0; i < now.emission.size(); ++i) {
    const TextureRange& range = now.emission[i];
    if (!are_same(before.emission[i], range)) return false;
    for (uint32_t k = range.first; k < range.first + range.count; ++k)
      if (std::memcmp(&fresh.textures[k], &view.textures[k], sizeof(fresh.textures[k])) != 0) return false;
  }
  return true;
}

bool have_names(const Scene& scene, const std::vector<std::string>& names) {
  return std::equal(scene.materials.begin(), scene.materials.end(), names.begin(), names.end(),
                    [](const Material& material, const std::string& name) { return material.name == name; });
}

/// Whether what was compiled of the shapes is the same with these materials.
template <class Real>
bool fit_shapes(const SceneArrays<Real>& fresh, const SceneView<Real>& view) {
  // Sides of one-sided surfaces get records of their own (compile/open_backs.h).
  if (fresh.materials.size() != view.materials_count) return false;
  for (size_t i = 0; i < fresh.materials.size(); ++i) {
    const MaterialRecord<Real>&a = fresh.materials[i], &b = view.materials[i];
    constexpr uint32_t of_shapes = MaterialFeatures::cutout | MaterialFeatures::one_sided | MaterialFeatures::tangents;
    if ((a.features & of_shapes) != (b.features & of_shapes) || (b.features & MaterialFeatures::one_sided))
      return false;
    if ((a.opacity.count > 0) != (b.opacity.count > 0)) return false;
  }
  return true;
}

}  // namespace

template <class Real>
bool update_materials(const Scene& description, CompiledScene<Real>& scene) {
  if (!scene.materials || !is_zero(scene.world_origin)) return false;
  if (filtered_images(description) != scene.materials->filtered_images) return false;
  if (!scene.material_names.empty() && !have_names(description, scene.materials->names)) return false;
  check_mixes(description);
  SceneArrays<Real> fresh;
  CompiledMaterials now = compile_materials_again(description, *scene.materials, fresh);
  if (now.needs_uv != scene.materials->needs_uv || !fit_shapes(fresh, scene.view) ||
      !have_same_emission(*scene.materials, now, fresh, scene.view))
    return false;
  ArrayFronts fronts;
#define ALHAZEN_REPLACE(name) fronts.name = whole_array(fresh.name, scene.view.name##_count);
  ALHAZEN_REPLACE(materials)
  ALHAZEN_REPLACE(albedo_tables)
  ALHAZEN_REPLACE(textures)
  ALHAZEN_REPLACE(texture_mappings)
  ALHAZEN_REPLACE(images)
#undef ALHAZEN_REPLACE
  replace_fronts(fronts, scene);
  scene.view.has_lobes = 0;
  for (const MaterialRecord<Real>& material : fresh.materials)
    if (has_trait<&MaterialTraits::has_lobes>(material.kind)) scene.view.has_lobes = 1;
  scene.materials = std::make_shared<const CompiledMaterials>(std::move(now));
  return true;
}

template bool update_materials(const Scene&, CompiledScene<float>&);
template bool update_materials(const Scene&, CompiledScene<double>&);

}  // namespace alhazen::impl
