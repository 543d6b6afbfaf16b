#include "compile/emission.h"

#include <algorithm>
#include <cmath>

#include "core/lights/light.h"

namespace alhazen::impl {

namespace {

/// Number of lookups for all lights together, and the maximum grid resolution for one.
constexpr double max_lookups = 4e6;
constexpr int coarsest = 8, finest = 128;

/// Sampling weight of a colour: its luminance, kept above zero unless the colour is black.
template <class Real>
double worth(const Vec3<Real>& colour) {
  return std::max(static_cast<double>(luminance(colour)), 1e-3 * static_cast<double>(max_component(colour)));
}

/// Mean of `value(b1, b2)` over a triangle, sampled at the cells of a grid of `side` rows of small triangles.
template <class Value>
double mean_over_triangle(int side, const Value& value) {
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; i + j < side; ++j) {
      sum += value((i + 1.0 / 3) / side, (j + 1.0 / 3) / side);
      if (i + j + 1 < side) sum += value((i + 2.0 / 3) / side, (j + 2.0 / 3) / side);
    }
  return sum / side / side;
}

/// Mean of `value(direction)` over the sphere.
template <class Value>
double mean_over_sphere(int side, const Value& value) {
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) sum += value(direction_of_octahedral(Vec2d{(i + 0.5) / side, (j + 0.5) / side}));
  return sum / side / side;
}

template <class Real>
double mean_factor(const SceneView<Real>& view, const LightRecord<Real>& light, int side) {
  const auto relative_luminance = [&](const Vec3<Real>& factor) {
    const double value = worth(light.radiance * factor) / worth(light.radiance);
    return std::isfinite(value) ? value : 0;
  };
  const auto on_sphere = [&](const Vec3<Real>& centre, Real radius, uint32_t frame) {
    return mean_over_sphere(side, [&](const Vec3d& d) {
      const Vec3<Real> outward = convert<Real>(d);
      return relative_luminance(sphere_emission_factor(view, light, frame, outward, centre + outward * radius));
    });
  };
  switch (light.kind) {
    case LightKind::sphere: {
      const SphereRecord<Real>& sphere = view.spheres[light.primitive];
      return on_sphere(sphere.centre, sphere.radius, sphere.frame);
    }
    case LightKind::moving_sphere: {
      const MovingSphereRecord<Real>& sphere = view.moving_spheres[light.primitive];
      return on_sphere(sphere.centre, sphere.radius, sphere.frame);
    }
    default:
      return mean_over_triangle(side, [&](double b1, double b2) {
        return relative_luminance(triangle_emission_factor(view, light, static_cast<Real>(b1), static_cast<Real>(b2)));
      });
  }
}

}  // namespace

template <class Real>
void weigh_emission_textures(const SceneView<Real>& view, const std::vector<uint8_t>& is_new,
                             std::vector<double>& measures) {
  const auto textured = std::count_if(view.lights, view.lights + view.lights_count,
                                      [](const LightRecord<Real>& light) { return light.texture.count > 0; });
  if (textured == 0) return;
  const int side =
      std::clamp(static_cast<int>(std::sqrt(max_lookups / static_cast<double>(textured))), coarsest, finest);
#pragma omp parallel for schedule(dynamic, 64)
  for (size_t i = 0; i < view.lights_count; ++i)
    if (view.lights[i].texture.count > 0 && (is_new.empty() || is_new[i]))
      measures[i] *= mean_factor(view, view.lights[i], side);
}

template void weigh_emission_textures(const SceneView<float>&, const std::vector<uint8_t>&, std::vector<double>&);
template void weigh_emission_textures(const SceneView<double>&, const std::vector<uint8_t>&, std::vector<double>&);

}  // namespace alhazen::impl
