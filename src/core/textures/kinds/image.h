#pragma once

// An image over (s, t), times a factor, or 1 minus that.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct ImageTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::st;

  template <class Description>
  static Vec3d parameters(const Description& texture) {
    return {texture.image_scale, texture.invert ? 1.0 : 0.0, 0};
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    const Vec3<Real> value = node.image() * node.parameters().x;
    return max(node.parameters().y != 0 ? splat(Real(1)) - value : value, Vec3<Real>{});
  }
};

}  // namespace ALHAZEN_CORE
