#pragma once

// One of two textures by the parity of the cell, over (s, t) or in space.

#include <cmath>

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct CheckerboardTexture : TextureBase {
  static constexpr uint32_t input_count = 2;  ///< even, odd
  static constexpr TextureDomain domain = TextureDomain::st_or_space;

  template <class Description>
  static int number(const Description& texture) {
    return texture.solid_checks ? 1 : 0;
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs) {
    Real cells;
    if (node.number()) {
      const Vec3<Real> p = node.point();
      cells = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
    } else {
      const Vec2<Real> st = node.st();
      cells = std::floor(st.x) + std::floor(st.y);
    }
    const bool is_even = cells - 2 * std::floor(cells * Real(0.5)) == 0;
    return is_even ? inputs[0] : inputs[1];
  }
};

}  // namespace ALHAZEN_CORE
