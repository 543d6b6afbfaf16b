#pragma once

// Cellular noise (Worley 1996, "A Cellular Texture Basis Function"): one point in every unit cell of texture space. The
// value is the distance to the closest of them, at most sqrt(3), or a random number in [0, 1) that belongs to it.

#include <cmath>

#include "core/sampling/hash.h"
#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

/// Hash of a cell. The pattern repeats every 2^16 cells.
ALHAZEN_HD inline uint32_t cellular_hash(int x, int y, int z) {
  const auto wrapped = [](int i) { return static_cast<uint32_t>(i) & 0xffffu; };
  return combine32(combine32(wrapped(x), wrapped(y)), wrapped(z));
}

/// The point of a cell, relative to the cell's lowest corner: its centre for a `jitter` of 0, anywhere in it for 1.
template <class Real>
ALHAZEN_HD Vec3<Real> cellular_point(uint32_t hash, Real jitter) {
  const auto coordinate = [&](uint32_t axis) {
    return Real(0.5) + jitter * (unit_interval<Real>(combine32(hash, axis)) - Real(0.5));
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

template <class Real>
struct CellularNoise {
  Real distance = 0;
  Real cell = 0;  ///< random number of the closest point's cell
};

template <class Real>
ALHAZEN_HD ALHAZEN_COLD CellularNoise<Real> cellular_noise(const Vec3<Real>& p, Real jitter) {
  const Vec3<Real> floors{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const Vec3<Real> within = p - floors;
  if (!(within.x + within.y + within.z <= 3)) return {};  // the point is infinite or NaN
  // Wrapping first keeps the conversion from overflowing.
  const auto cell_of = [](Real f) { return static_cast<int>(f - Real(65536) * std::floor(f * Real(1.0 / 65536))); };
  const int x = cell_of(floors.x), y = cell_of(floors.y), z = cell_of(floors.z);
  Real closest = 4;  // squared; the point of the own cell is closer
  uint32_t hash = 0;
  const auto gap = [](int offset, Real f) {
    return offset > 0 ? static_cast<Real>(offset) - f : offset < 0 ? f - static_cast<Real>(offset + 1) : Real(0);
  };
  const auto visit = [&](int i, int j, int k) {
    const Vec3<Real> gaps{gap(i, within.x), gap(j, within.y), gap(k, within.z)};
    if (!(length_squared(gaps) < closest)) return;
    const uint32_t h = cellular_hash(x + i, y + j, z + k);
    const Vec3<Real> corner{static_cast<Real>(i), static_cast<Real>(j), static_cast<Real>(k)};
    const Real squared = length_squared(corner + cellular_point(h, jitter) - within);
    if (!(squared < closest)) return;
    closest = squared;
    hash = h;
  };
  visit(0, 0, 0);
  // Cells two away may hold the closest point only if none is within a distance of 1.
  for (int ring = 1; ring <= 2 && (ring == 1 || closest > 1); ++ring)
    for (int k = -ring; k <= ring; ++k)
      for (int j = -ring; j <= ring; ++j)
        for (int i = -ring; i <= ring; ++i) visit(i, j, k);
  return {std::sqrt(closest), unit_interval<Real>(combine32(hash, 3))};
}

struct CellularTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::space;

  /// Of Texture::value: x is the jitter, from 0 to 1; y is 1 for the random number of the cell, 0 for the distance.
  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    const CellularNoise<Real> noise = cellular_noise(node.point(), node.parameters().x);
    return splat(node.parameters().y != 0 ? noise.cell : noise.distance);
  }
};

}  // namespace ALHAZEN_CORE
