#pragma once

// (s, t, 0) of the mapping.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct CoordinatesTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::st;

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    const Vec2<Real> st = node.st();
    return {st.x, st.y, 0};
  }
};

}  // namespace ALHAZEN_CORE
