#pragma once

// Perlin's gradient noise and its sums over octaves, in three dimensions.

#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD Real noise_gradient(const uint8_t* permutation, int x, int y, int z, const Vec3<Real>& d) {
  const auto perm = [&](int i) -> int { return permutation[i & 255]; };
  const int h = perm(perm(perm(x) + y) + z) & 15;
  const Real u = h < 8 || h == 12 || h == 13 ? d.x : d.y;
  const Real v = h < 4 || h == 12 || h == 13 ? d.y : d.z;
  return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

/// Gradient noise in about [-1, 1], 0 at integer points (Perlin 2002, "Improving Noise").
/// `permutation` holds 256 bytes, a permutation of 0 to 255.
template <class Real>
ALHAZEN_HD Real perlin_noise(const uint8_t* permutation, const Vec3<Real>& p) {
  const Real fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const Vec3<Real> d{p.x - fx, p.y - fy, p.z - fz};
  if (!(d.x + d.y + d.z <= 3)) return 0;  // the point is infinite or NaN
  // The lattice repeats every 256 cells; wrapping first keeps the conversion from overflowing.
  const auto cell = [](Real f) { return static_cast<int>(f - Real(256) * std::floor(f * Real(1.0 / 256))); };
  const int x = cell(fx), y = cell(fy), z = cell(fz);
  const auto corner = [&](int i, int j, int k) {
    return noise_gradient(permutation, x + i, y + j, z + k,
                          d - Vec3<Real>{static_cast<Real>(i), static_cast<Real>(j), static_cast<Real>(k)});
  };
  const auto fade = [](Real t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const auto blend = [](Real a, Real b, Real t) { return a + (b - a) * t; };
  const Real u = fade(d.x), v = fade(d.y), w = fade(d.z);
  const Real low = blend(blend(corner(0, 0, 0), corner(1, 0, 0), u), blend(corner(0, 1, 0), corner(1, 1, 0), u), v);
  const Real high = blend(blend(corner(0, 0, 1), corner(1, 0, 1), u), blend(corner(0, 1, 1), corner(1, 1, 1), u), v);
  return blend(low, high, w);
}

/// Sum of `octaves` noises, each at 1.99 times the frequency and `roughness` times the amplitude of the previous one
/// (fractional Brownian motion); with `absolute` the sum of their absolute values (turbulence).
template <class Real>
ALHAZEN_HD ALHAZEN_COLD Real octave_noise(const uint8_t* permutation, Vec3<Real> p, Real roughness, uint32_t octaves,
                                          bool absolute) {
  Real sum = 0, amplitude = 1;
  for (uint32_t i = 0; i < octaves; ++i) {
    const Real n = perlin_noise(permutation, p);
    sum += amplitude * (absolute ? std::abs(n) : n);
    amplitude *= roughness;
    p *= Real(1.99);
  }
  return sum;
}

}  // namespace ALHAZEN_CORE
