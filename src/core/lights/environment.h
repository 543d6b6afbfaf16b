#pragma once

// An environment map: radiance from infinitely far away, given by an image of the whole sphere with bilinear
// interpolation. It is sampled by a distribution that is constant over each texel: first a row, then a texel in the row
// (Pharr, Jakob, Humphreys 2016, 14.2.4). The density is that of the radiance above its mean, since BSDF sampling finds
// the rest with less variance. Densities are over solid angle.

#include "core/lights/kinds/light_base.h"
#include "core/lights/sphere_mapping.h"
#include "core/sampling/discrete.h"

namespace ALHAZEN_CORE {

template <class Real>
struct EnvironmentSample {
  Vec3<Real> direction{};  ///< unit, in world space
  Vec3<Real> radiance{};
  Real pdf = 0;  ///< 0 if nothing was sampled
};

template <class Real>
ALHAZEN_HD Vec3<Real> environment_texel(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map, int x,
                                        int y) {
  const Texel at = texel_of_sphere(map.mapping, x, y, static_cast<int>(map.width), static_cast<int>(map.height));
  const uint64_t index = static_cast<uint64_t>(at.y) * map.width + static_cast<uint64_t>(at.x);
  const float* t = scene.texel_floats + map.first_texel + 3 * index;
  return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
}

/// Radiance at a point of the image; texel centres are at half integers.
template <class Real>
ALHAZEN_HD Vec3<Real> lookup_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                         const Vec2<Real>& uv) {
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return {};  // the direction is NaN
  const Real x = uv.x * static_cast<Real>(map.width) - Real(0.5), y = uv.y * static_cast<Real>(map.height) - Real(0.5);
  const Real fx = std::floor(x), fy = std::floor(y);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const Vec3<Real> top = lerp(environment_texel(scene, map, ix, iy), environment_texel(scene, map, ix + 1, iy), x - fx);
  const Vec3<Real> bottom =
      lerp(environment_texel(scene, map, ix, iy + 1), environment_texel(scene, map, ix + 1, iy + 1), x - fx);
  return lerp(top, bottom, y - fy) * map.scale;
}

/// Radiance that arrives from unit `direction`, which points out of the scene.
template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                           const Vec3<Real>& direction) {
  return lookup_environment(scene, map, square_of_direction(map.mapping, map.axes.to_local(direction)));
}

/// Density over the unit square within texel (column, row).
template <class Real>
ALHAZEN_HD Real environment_square_pdf(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map, uint32_t row,
                                       uint32_t column) {
  const Real* rows = scene.environment_cdf + map.first_cdf;
  const Real* columns = rows + (map.height + 1) + static_cast<uint64_t>(row) * (map.width + 1) + column;
  return (rows[row + 1] - rows[row]) * static_cast<Real>(map.height) *
         ((columns[1] - columns[0]) * static_cast<Real>(map.width));
}

template <class Real>
ALHAZEN_HD EnvironmentSample<Real> sample_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                                      const Vec2<Real>& u) {
  EnvironmentSample<Real> s;
  const Real* rows = scene.environment_cdf + map.first_cdf;
  const uint32_t row = sample_cdf(rows, map.height, u.y);
  const Real* columns = rows + (map.height + 1) + static_cast<uint64_t>(row) * (map.width + 1);
  const uint32_t column = sample_cdf(columns, map.width, u.x);
  const Vec2<Real> uv{
      (static_cast<Real>(column) + position_within(columns, column, u.x)) / static_cast<Real>(map.width),
      (static_cast<Real>(row) + position_within(rows, row, u.y)) / static_cast<Real>(map.height)};
  const Vec3<Real> direction = direction_of_square(map.mapping, uv);
  const Real solid_angle = solid_angle_of_square(map.mapping, direction);
  if (!(solid_angle > 0)) return s;
  s.direction = map.axes.to_world(direction);
  s.radiance = lookup_environment(scene, map, uv);
  s.pdf = environment_square_pdf(scene, map, row, column) / solid_angle;
  return s;
}

/// Density with which `sample_environment` returns the direction that is `local` to the map and has coordinates `uv`.
template <class Real>
ALHAZEN_HD Real pdf_environment_at(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                   const Vec3<Real>& local, const Vec2<Real>& uv) {
  const Real solid_angle = solid_angle_of_square(map.mapping, local);
  if (!(solid_angle > 0)) return 0;
  if (!(uv.x >= 0 && uv.y >= 0)) return 0;
  const uint32_t column = static_cast<uint32_t>(uv.x * static_cast<Real>(map.width));
  const uint32_t row = static_cast<uint32_t>(uv.y * static_cast<Real>(map.height));
  return environment_square_pdf(scene, map, row < map.height ? row : map.height - 1,
                                column < map.width ? column : map.width - 1) /
         solid_angle;
}

/// Density with which `sample_environment` returns unit `direction`.
template <class Real>
ALHAZEN_HD Real pdf_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                const Vec3<Real>& direction) {
  const Vec3<Real> local = map.axes.to_local(direction);
  return pdf_environment_at(scene, map, local, square_of_direction(map.mapping, local));
}

/// The map's radiance for a ray that escapes along unit `direction`, and its density if `wants_pdf`. Both use the same
/// lookup, which is done once.
template <class Real>
ALHAZEN_HD EnvironmentSample<Real> evaluate_environment_and_pdf(const SceneView<Real>& scene,
                                                                const EnvironmentRecord<Real>& map,
                                                                const Vec3<Real>& direction, bool wants_pdf) {
  const Vec3<Real> local = map.axes.to_local(direction);
  const Vec2<Real> uv = square_of_direction(map.mapping, local);
  EnvironmentSample<Real> s{direction, lookup_environment(scene, map, uv), 0};
  if (wants_pdf && !is_zero(s.radiance)) s.pdf = pdf_environment_at(scene, map, local, uv);
  return s;
}

}  // namespace ALHAZEN_CORE
