#include "compile/change_lights.h"

#include <algorithm>

#include "compile/emission.h"
#include "compile/lights.h"
#include "compile/shapes.h"
#include "scene/scene_names.h"

namespace alhazen::impl {

namespace {

bool has_map(const Light& light) { return light.kind == LightKind::environment || light_traits(light.kind).has_image; }

/// Whether the map of every light is compiled, or has its texels.
template <class Real>
bool has_maps(const Scene& scene, const LightMaps<Real>& maps, bool as_texels) {
  return std::all_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    if (!has_map(light) || is_zero(light.radiance)) return true;
    const bool is_environment = light.kind == LightKind::environment;
    const uint32_t index = is_environment ? light.environment : light.image;
    if (as_texels) {
      const std::vector<ImageTexels>& images = is_environment ? scene.environments : scene.light_images;
      return index < images.size() && !images[index].floats.empty();
    }
    if (is_environment) return index < maps.environments.size() && maps.environments[index].has_value();
    return index < maps.images.size() && maps.images[index].has_value();
  });
}

/// Whether groups of lights are as they were: they follow from names, and from which lights shine.
template <class Real>
bool has_same_groups(const Scene& outline, const std::vector<size_t>& described, const BuiltParts<Real>& parts) {
  const Scene& before = parts.scene;
  if (described != parts.described_lights || light_names(outline) != light_names(before)) return false;
  const auto is_background = [](const Light& light) {
    return light.kind == LightKind::constant_infinite && !is_zero(light.radiance);
  };
  return std::equal(
      outline.lights.begin(), outline.lights.end(), before.lights.begin(), before.lights.end(),
      [&](const Light& a, const Light& b) { return a.name == b.name && is_background(a) == is_background(b); });
}

/// Appends the lights of shapes: what was compiled of them, with the values of `outline`.
template <class Real>
void add_shape_lights(const std::vector<MovedShape>& emitters, const Scene& outline, const CompiledScene<Real>& scene,
                      const BuiltParts<Real>& parts, SceneArrays<Real>& fresh) {
  const LightRecord<Real>* const before = scene.view.lights + parts.described_lights.size();
  for (const MovedShape& emitter : emitters) {
    LightRecord<Real> light = shape_light<Real>(*emitter.placement.shape, outline, *scene.materials);
    for (uint32_t i = parts.placed[emitter.index].lights; i < parts.placed[emitter.index + 1].lights; ++i) {
      light.kind = before[i].kind;
      light.primitive = before[i].primitive;
      fresh.lights.push_back(light);
    }
  }
}

/// Where lights come to other indices, surfaces must refer to these.
template <class Real>
void shift_surfaces(size_t before, size_t after, CompiledScene<Real>& scene) {
  if (before == after) return;
  auto* const surfaces = const_cast<SurfaceRecord*>(scene.view.surfaces);  // the arena is the scene's own
  for (uint32_t i = 0; i < scene.view.surfaces_count; ++i)
    if (surfaces[i].light != no_light)
      surfaces[i].light += static_cast<uint32_t>(after) - static_cast<uint32_t>(before);
}

}  // namespace

template <class Real>
bool change_lights(const std::vector<MovedShape>& emitters, const std::vector<uint8_t>& is_new, Scene& outline,
                   CompiledScene<Real>& scene, BuiltParts<Real>& parts) {
  SceneView<Real>& view = scene.view;
  const bool keeps_maps = has_maps(outline, parts.maps, false);
  if (!keeps_maps && !has_maps(outline, parts.maps, true)) return false;
  SceneArrays<Real> fresh;
  if (!keeps_maps) {
    parts.maps = {};
    fresh.texel_floats.assign(view.texel_floats, view.texel_floats + parts.texture_floats);
  }
  std::vector<double> measures;
  const std::vector<size_t> described =
      add_described_lights(outline, view.texel_floats, parts.maps, fresh, view, measures);
  if (parts.options.groups_lights && !has_same_groups(outline, described, parts)) return false;
  add_shape_lights(emitters, outline, scene, parts, fresh);
  for (size_t i = 0; i < is_new.size(); ++i)
    if (is_new[i]) parts.measures[i] = parts.areas[i];
  measures.insert(measures.end(), parts.measures.begin(), parts.measures.end());
  std::vector<uint8_t> is_weighed(described.size());
  is_weighed.insert(is_weighed.end(), is_new.begin(), is_new.end());
  SceneView<Real> shapes = view;
  shapes.lights = fresh.lights.data();
  shapes.lights_count = static_cast<uint32_t>(fresh.lights.size());
  shapes.light_images = fresh.light_images.data();
  shapes.light_images_count = static_cast<uint32_t>(fresh.light_images.size());
  weigh_emission_textures(shapes, is_weighed, measures);
  parts.measures.assign(measures.begin() + static_cast<ptrdiff_t>(described.size()), measures.end());
  add_triangle_emitters(shapes, fresh);
  view.infinite_irradiance = 0;
  assign_light_probabilities(measures, outline.light_sampling, shapes, fresh, view);
  ArrayFronts fronts;
#define ALHAZEN_REPLACE(name) fronts.name = whole_array(fresh.name, view.name##_count);
  ALHAZEN_REPLACE(lights)
  ALHAZEN_REPLACE(far_lights)
  ALHAZEN_REPLACE(triangle_emitters)
  ALHAZEN_REPLACE(environments)
  ALHAZEN_REPLACE(light_cdf)
  ALHAZEN_REPLACE(light_tree)
  ALHAZEN_REPLACE(light_images)
  if (!keeps_maps) {
    ALHAZEN_REPLACE(environment_cdf)
    ALHAZEN_REPLACE(texel_floats)
  }
#undef ALHAZEN_REPLACE
  replace_fronts(fronts, scene);
  shift_surfaces(parts.described_lights.size(), described.size(), scene);
  scene.backs.has_only_delta_lights = !scene.backs.closed.empty() && has_only_delta_lights(fresh.lights, view);
  scene.statistics.lights = fresh.lights.size() + (is_zero(view.background) ? 0 : 1);
  parts.described_lights = described;
  return true;
}

template bool change_lights(const std::vector<MovedShape>&, const std::vector<uint8_t>&, Scene&, CompiledScene<float>&,
                            BuiltParts<float>&);
template bool change_lights(const std::vector<MovedShape>&, const std::vector<uint8_t>&, Scene&, CompiledScene<double>&,
                            BuiltParts<double>&);

}  // namespace alhazen::impl
