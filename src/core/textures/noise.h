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

/// Waves whose height is scaled by wind strength, a noise of lower frequency.
template <class Real>
ALHAZEN_HD Real windy_waves(const uint8_t* permutation, const Vec3<Real>& p) {
  const Real strength = octave_noise(permutation, p * Real(0.1), Real(0.5), 3, false);
  return std::abs(strength) * octave_noise(permutation, p, Real(0.5), 6, false);
}

/// Returns whether (s, t) is inside a disc of radius 0.35. About half of the cells, which are centred at the integers,
/// contain one, displaced within the cell by noise (PBR 3rd ed., 10.5.1).
template <class Real>
ALHAZEN_HD bool is_inside_dot(const uint8_t* permutation, const Vec2<Real>& st) {
  constexpr Real radius = Real(0.35), max_shift = Real(0.5) - radius;
  const Real s = std::floor(st.x + Real(0.5)), t = std::floor(st.y + Real(0.5));
  const auto noise = [&](Real ds, Real dt) { return perlin_noise(permutation, Vec3<Real>{s + ds, t + dt, Real(0.5)}); };
  if (!(noise(Real(0.5), Real(0.5)) > 0)) return false;
  const Real ds = st.x - (s + max_shift * noise(Real(1.5), Real(2.8)));
  const Real dt = st.y - (t + max_shift * noise(Real(4.5), Real(9.8)));
  return ds * ds + dt * dt < radius * radius;
}

}  // namespace ALHAZEN_CORE
