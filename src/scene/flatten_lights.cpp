#include "scene/flatten_lights.h"

#include <cmath>
#include <numbers>

#include "scene/flatten_environment.h"

namespace alhazen {

namespace {

bool is_at_infinity(LightKind kind) {
  return kind == LightKind::distant || kind == LightKind::constant_infinite || kind == LightKind::environment;
}

/// Emitted power, W, by luminance; of lights at infinity the irradiance, W / m^2, that they make.
template <class Real>
double light_weight(const LightRecord<Real>& light, double area) {
  const double value = static_cast<double>(luminance(light.radiance));
  const double strongest = static_cast<double>(max_component(light.radiance));
  const double amount = std::max(value, 1e-3 * strongest);
  switch (light.kind) {
    case LightKind::point:
      return amount * 4 * std::numbers::pi;
    case LightKind::spot:
      return amount * 2 * std::numbers::pi * (1 - 0.5 * static_cast<double>(light.cos_outer + light.cos_inner));
    case LightKind::distant:
      return amount;
    case LightKind::constant_infinite:
    case LightKind::environment:
      return amount * std::numbers::pi;
    default:
      return amount * std::numbers::pi * area * (light.two_sided ? 2 : 1);
  }
}

double cos_degrees(double angle) { return std::cos(angle * std::numbers::pi / 180); }

}  // namespace

template <class Real>
void add_described_lights(Scene& scene, SceneArrays<Real>& out, SceneView<Real>& view) {
  Vec3d background{};
  for (const Light& light : scene.lights) {
    if (!is_finite(light.radiance) || !is_finite(light.position) || !is_finite(light.direction))
      throw InputError(light.where, "the light has a value that is not finite");
    LightRecord<Real> record{};
    record.radiance = convert<Real>(light.radiance);
    record.position = convert<Real>(light.position);
    record.direction = convert<Real>(light.direction);
    switch (light.type) {
      case LightType::constant_infinite:
        background += light.radiance;
        continue;
      case LightType::environment:
        add_environment(light, scene, out);
        continue;
      case LightType::point:
        record.kind = LightKind::point;
        break;
      case LightType::distant:
        record.kind = LightKind::distant;
        break;
      case LightType::spot:
        record.kind = LightKind::spot;
        record.cos_outer = static_cast<Real>(cos_degrees(light.cone_angle));
        record.cos_inner = static_cast<Real>(cos_degrees(std::min(light.falloff_start, light.cone_angle)));
        break;
    }
    if (!is_zero(light.radiance)) out.lights.push_back(record);
  }
  if (is_zero(background)) return;
  LightRecord<Real> record{};
  record.kind = LightKind::constant_infinite;
  record.radiance = convert<Real>(background);
  view.background = record.radiance;
  view.background_light = static_cast<uint32_t>(out.lights.size());
  out.lights.push_back(record);
}

template <class Real>
void assign_light_probabilities(const std::vector<double>& areas, SceneArrays<Real>& out) {
  const size_t count = out.lights.size();
  std::vector<double> weights(count);
  double total[2] = {0, 0};
  for (size_t i = 0; i < count; ++i) {
    weights[i] = light_weight(out.lights[i], i < areas.size() ? areas[i] : 0);
    total[is_at_infinity(out.lights[i].kind)] += weights[i];
  }
  const bool both = total[0] > 0 && total[1] > 0;
  double sum = 0;
  out.light_cdf.assign(1, Real(0));
  for (size_t i = 0; i < count; ++i) {
    const double share = total[is_at_infinity(out.lights[i].kind)];
    const double pmf = share > 0 ? weights[i] / share * (both ? 0.5 : 1) : 0;
    out.lights[i].pmf = static_cast<Real>(pmf);
    sum += pmf;
    out.light_cdf.push_back(i + 1 == count ? Real(1) : static_cast<Real>(sum));
  }
}

template void add_described_lights(Scene&, SceneArrays<float>&, SceneView<float>&);
template void add_described_lights(Scene&, SceneArrays<double>&, SceneView<double>&);
template void assign_light_probabilities(const std::vector<double>&, SceneArrays<float>&);
template void assign_light_probabilities(const std::vector<double>&, SceneArrays<double>&);

}  // namespace alhazen
