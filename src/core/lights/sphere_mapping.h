#pragma once

// Images of the whole sphere: mappings between directions and points of the unit square, u to the right and v down the
// image. The middle row of an equirectangular image is the horizon; z is up in both mappings.

#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

enum class SphereMapping : uint32_t {
  equirectangular,  ///< u is longitude from +x over +y, v the angle from +z
  octahedral,       ///< equal-area (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD")
};

template <class Real>
ALHAZEN_HD Vec3<Real> direction_of_equirectangular(const Vec2<Real>& uv) {
  const auto [sin_theta, cos_theta] = sine_cosine_of_turn(pi<Real> * uv.y);
  const auto [sin_phi, cos_phi] = sine_cosine_of_turn(2 * pi<Real> * uv.x);
  return {sin_theta * cos_phi, sin_theta * sin_phi, cos_theta};
}

template <class Real>
ALHAZEN_HD Vec2<Real> equirectangular_of_direction(const Vec3<Real>& d) {
  const Real u = std::atan2(d.y, d.x) * (Real(0.5) * inv_pi<Real>);
  return {u < 0 ? u + 1 : u, std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z) * inv_pi<Real>};
}

/// The square's inner diamond is the upper hemisphere; its four corners are folded together at -z.
template <class Real>
ALHAZEN_HD Vec3<Real> direction_of_octahedral(const Vec2<Real>& uv) {
  const Real x = 2 * uv.x - 1, y = 2 * uv.y - 1;
  const bool is_upper = std::abs(x) + std::abs(y) <= 1;
  const Real a = is_upper ? std::abs(x) : 1 - std::abs(y), b = is_upper ? std::abs(y) : 1 - std::abs(x);
  const Real r = a + b;
  const auto [sine, cosine] = sine_cosine_of_turn(r > 0 ? pi<Real> / 2 * (b / r) : Real(0));
  const Real to_axis = r * std::sqrt(2 - r * r), z = 1 - r * r;
  return {std::copysign(cosine * to_axis, x), std::copysign(sine * to_axis, y), is_upper ? z : -z};
}

template <class Real>
ALHAZEN_HD Vec2<Real> octahedral_of_direction(const Vec3<Real>& d) {
  const Real x = std::abs(d.x), y = std::abs(d.y);
  // sqrt(1 - |z|) without cancellation near the poles.
  const Real r = std::sqrt((x * x + y * y) / (1 + std::abs(d.z)));
  const Real b = r > 0 ? r * std::atan2(y, x) * (2 * inv_pi<Real>) : Real(0), a = r - b;
  const Real u = d.z < 0 ? 1 - b : a, v = d.z < 0 ? 1 - a : b;
  return {clamp((std::copysign(u, d.x) + 1) * Real(0.5), Real(0), Real(1)),
          clamp((std::copysign(v, d.y) + 1) * Real(0.5), Real(0), Real(1))};
}

template <class Real>
ALHAZEN_HD Vec3<Real> direction_of_square(SphereMapping mapping, const Vec2<Real>& uv) {
  return mapping == SphereMapping::octahedral ? direction_of_octahedral(uv) : direction_of_equirectangular(uv);
}

template <class Real>
ALHAZEN_HD Vec2<Real> square_of_direction(SphereMapping mapping, const Vec3<Real>& d) {
  return mapping == SphereMapping::octahedral ? octahedral_of_direction(d) : equirectangular_of_direction(d);
}

/// Solid angle in steradians per area of the square about the point of direction `d`.
template <class Real>
ALHAZEN_HD Real solid_angle_of_square(SphereMapping mapping, const Vec3<Real>& d) {
  return mapping == SphereMapping::octahedral ? 4 * pi<Real>
                                              : 2 * pi<Real> * pi<Real> * std::sqrt(d.x * d.x + d.y * d.y);
}

struct Texel {
  int x, y;
};

/// The texel at (x, y), which may be one beyond the edges: an octahedral image continues there with the same edge
/// reversed; an equirectangular one wraps around horizontally, and its rows end at the poles.
ALHAZEN_HD inline Texel texel_of_sphere(SphereMapping mapping, int x, int y, int width, int height) {
  if (mapping == SphereMapping::octahedral) {
    if (x < 0 || x >= width) {
      x = x < 0 ? 0 : width - 1;
      y = height - 1 - y;
    }
    if (y < 0 || y >= height) {
      y = y < 0 ? 0 : height - 1;
      x = width - 1 - x;
    }
    return {x, y};
  }
  return {x < 0 ? width - 1 : x >= width ? 0 : x, y < 0 ? 0 : y >= height ? height - 1 : y};
}

}  // namespace ALHAZEN_CORE
