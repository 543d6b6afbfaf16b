#pragma once

// One of two textures: inside or outside discs that noise scatters over (s, t).

#include "core/textures/kinds/texture_base.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

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

struct DotsTexture : TextureBase {
  static constexpr uint32_t input_count = 2;  ///< inside, outside
  static constexpr TextureDomain domain = TextureDomain::st;

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs) {
    return is_inside_dot(node.permutation(), node.st()) ? inputs[0] : inputs[1];
  }
};

}  // namespace ALHAZEN_CORE
