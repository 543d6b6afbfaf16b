#include "compile/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compile/environment.h"
#include "compile/light_tree_builder.h"
#include "core/lights/light.h"

namespace alhazen::impl {

namespace {

/// Emitted power, W, by luminance; for lights at infinity their irradiance, W / m^2.
template <class Real>
double light_weight(const LightRecord<Real>& light, double measure) {
  const double value = static_cast<double>(luminance(light.radiance));
  const double strongest = static_cast<double>(max_component(light.radiance));
  const double amount = std::max(value, 1e-3 * strongest);
  switch (light.kind) {
#define ALHAZEN_CASE(name, Name) \
  case LightKind::name:          \
    return Name##Light::power(light, amount, measure);
    ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
    case LightKind::triangle:
    case LightKind::sphere:
    case LightKind::moving_sphere:
      break;
  }
  return amount * std::numbers::pi * measure * (light.two_sided ? 2 : 1);
}

/// Sets the members of the kind.
template <class Real>
void set_record(const Light& light, LightRecord<Real>& record) {
  switch (light.kind) {
#define ALHAZEN_CASE(name, Name)            \
  case LightKind::name:                     \
    Name##Light::set_record(light, record); \
    break;
    ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
    case LightKind::triangle:
    case LightKind::sphere:
    case LightKind::moving_sphere:
      break;
  }
}

/// Appends the texels of the image of a light.
template <class Real>
LightImageRecord<Real> add_texels(const Light& light, const ImageTexels& image, SceneArrays<Real>& out) {
  if (image.width < 1 || image.height < 1 || (light.kind == LightKind::goniometric && image.width != image.height) ||
      image.floats.size() != 3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height))
    throw InputError(light.where, "the image of a light does not hold three values per texel, or is not square");
  LightImageRecord<Real> record{};
  record.first_texel = out.texel_floats.size();
  record.width = static_cast<uint32_t>(image.width);
  record.height = static_cast<uint32_t>(image.height);
  out.texel_floats.insert(out.texel_floats.end(), image.floats.begin(), image.floats.end());
  return record;
}

/// Appends the image of a light. Returns its luminance integrated over all directions, steradians.
template <class Real>
double add_light_image(const Light& light, const Scene& scene, const float* texels, LightMaps<Real>& maps,
                       SceneArrays<Real>& out) {
  if (light.image >= scene.light_images.size()) throw InputError(light.where, "the light names no image");
  const ImageTexels& image = scene.light_images[light.image];
  const bool is_sphere = light.kind == LightKind::goniometric;
  maps.images.resize(scene.light_images.size());
  std::optional<LightImageRecord<Real>>& compiled = maps.images[light.image];
  const float* const floats = compiled ? texels + compiled->first_texel : image.floats.data();
  if (!compiled) compiled = add_texels(light, image, out);
  LightImageRecord<Real> record = *compiled;
  record.axes = {convert<Real>(light.axes.tangent), convert<Real>(light.axes.bitangent),
                 convert<Real>(light.axes.normal)};
  const double width = record.width, height = record.height;
  const double half = std::tan(light.fov * std::numbers::pi / 360), shorter = std::min(width, height);
  record.half_width = static_cast<Real>(half * width / shorter);
  record.half_height = static_cast<Real>(half * height / shorter);
  double integral = 0;
  const float* t = floats;
  for (uint32_t y = 0; y < record.height; ++y)
    for (uint32_t x = 0; x < record.width; ++x, t += 3) {
      const Vec3d colour{static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])};
      double solid_angle = 4 * std::numbers::pi / (width * height);
      if (!is_sphere) {
        const double px = half / shorter * (2 * x + 1 - width), py = half / shorter * (2 * y + 1 - height);
        solid_angle = sqr(2 * half / shorter) / std::pow(1 + px * px + py * py, 1.5);
      }
      integral += luminance(colour) * solid_angle;
    }
  out.light_images.push_back(record);
  return integral;
}

}  // namespace

template <class Real>
std::vector<size_t> add_described_lights(Scene& scene, const float* texels, LightMaps<Real>& maps,
                                         SceneArrays<Real>& out, SceneView<Real>& view, std::vector<double>& measures) {
  Vec3d background{};
  std::vector<size_t> described;
  for (const Light& light : scene.lights) {
    if (!is_finite(light.radiance) || !is_finite(light.position) || !is_finite(light.direction))
      throw InputError(light.where, "the light has a value that is not finite");
    LightRecord<Real> record{};
    record.kind = light.kind;
    record.radiance = convert<Real>(light.radiance);
    record.position = convert<Real>(light.position);
    record.direction = convert<Real>(light.direction);
    set_record(light, record);
    if (!is_finite(record.radiance) || !is_finite(record.position))
      throw InputError(light.where, "the light is too bright or too far away for this precision");
    if (light.kind == LightKind::constant_infinite) {
      background += light.radiance;
      continue;
    }
    const size_t index = out.lights.size();
    if (light.kind == LightKind::environment) {
      const double excess = add_environment(light, scene, maps, out);
      if (out.lights.size() > index) measures.push_back(excess);
    } else if (!is_zero(light.radiance)) {
      if (light_traits(light.kind).has_image) {
        record.primitive = static_cast<uint32_t>(out.light_images.size());
        record.direction = convert<Real>(light.axes.normal);
        measures.push_back(add_light_image(light, scene, texels, maps, out));
      }
      out.lights.push_back(record);
    }
    measures.resize(out.lights.size());
    described.resize(out.lights.size(), static_cast<size_t>(&light - scene.lights.data()));
    if (out.lights.size() > index && light_traits(light.kind).is_at_infinity && light_traits(light.kind).has_size)
      out.far_lights.push_back(static_cast<uint32_t>(index));
  }
  view.background = convert<Real>(background);
  if (!is_finite(view.background))
    throw InputError({scene.name}, "the infinite lights are together too bright for this precision");
  return described;
}

template <class Real>
bool has_only_delta_lights(const std::vector<LightRecord<Real>>& lights, const SceneView<Real>& view) {
  return is_zero(view.background) && std::all_of(lights.begin(), lights.end(), [](const LightRecord<Real>& light) {
           return !light_traits(light.kind).has_size;
         });
}

template bool has_only_delta_lights(const std::vector<LightRecord<float>>&, const SceneView<float>&);
template bool has_only_delta_lights(const std::vector<LightRecord<double>>&, const SceneView<double>&);

template <class Real>
void assign_light_probabilities(const std::vector<double>& measures, LightSampling sampling,
                                const SceneView<Real>& shapes, SceneArrays<Real>& out, SceneView<Real>& view) {
  const size_t count = out.lights.size();
  std::vector<double> weights(count);
  double total[2] = {0, 0};
  size_t finite = 0;
  for (size_t i = 0; i < count; ++i) {
    const bool is_infinite = light_traits(out.lights[i].kind).is_at_infinity;
    weights[i] = light_weight(out.lights[i], i < measures.size() ? measures[i] : 0);
    total[is_infinite] += weights[i];
    finite += !is_infinite && weights[i] > 0 ? 1 : 0;
  }
  const bool both = total[0] > 0 && total[1] > 0;
  const bool has_tree = finite > 0 && sampling != LightSampling::power &&
                        (sampling == LightSampling::tree || both || finite > max_lights_without_tree);
  // With a tree the others are chosen among the lights at infinity, which precede all shapes.
  const double of_group = both && !has_tree ? 0.5 : 1;
  size_t chosen = count;
  while (has_tree && chosen > 0 && !light_traits(out.lights[chosen - 1].kind).is_at_infinity) --chosen;
  size_t last = chosen;  // that can be chosen: the distribution ends there
  while (last > 1 && !(weights[last - 1] > 0)) --last;
  double sum = 0;
  out.light_cdf.assign(1, Real(0));
  for (size_t i = 0; i < count; ++i) {
    const bool is_infinite = light_traits(out.lights[i].kind).is_at_infinity;
    const double total_weight = total[is_infinite];
    const double pmf = total_weight > 0 ? weights[i] / total_weight * of_group : 0;
    out.lights[i].pmf = static_cast<Real>(pmf);
    if (i >= chosen) continue;
    if (is_infinite || !has_tree) sum += pmf;
    out.light_cdf.push_back(i + 1 >= last ? Real(1) : static_cast<Real>(sum));
  }
  if (!has_tree) return;
  const double largest = std::numeric_limits<Real>::max();
  view.infinite_irradiance = static_cast<Real>(std::min(total[1], largest));
  build_light_tree(weights, shapes, out);
}

template <class Real>
void add_triangle_emitters(const SceneView<Real>& shapes, SceneArrays<Real>& out) {
  for (LightRecord<Real>& light : out.lights) {
    if (light.kind != LightKind::triangle) continue;
    light.emitter = static_cast<uint32_t>(out.triangle_emitters.size());
    out.triangle_emitters.push_back(make_triangle_emitter(shapes, light));
  }
}

template std::vector<size_t> add_described_lights(Scene&, const float*, LightMaps<float>&, SceneArrays<float>&,
                                                  SceneView<float>&, std::vector<double>&);
template std::vector<size_t> add_described_lights(Scene&, const float*, LightMaps<double>&, SceneArrays<double>&,
                                                  SceneView<double>&, std::vector<double>&);
template void add_triangle_emitters(const SceneView<float>&, SceneArrays<float>&);
template void add_triangle_emitters(const SceneView<double>&, SceneArrays<double>&);
template void assign_light_probabilities(const std::vector<double>&, LightSampling, const SceneView<float>&,
                                         SceneArrays<float>&, SceneView<float>&);
template void assign_light_probabilities(const std::vector<double>&, LightSampling, const SceneView<double>&,
                                         SceneArrays<double>&, SceneView<double>&);

}  // namespace alhazen::impl
