#pragma once

// Two textures blended by the cosine of the normal and a direction.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct DirectionMixTexture : TextureBase {
  static constexpr uint32_t input_count = 2;  ///< value where the normal is along the direction, where perpendicular

  template <class Description>
  static Vec3d parameters(const Description& texture) {
    return normalize(texture.direction);
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs) {
    return lerp(inputs[1], inputs[0], abs_dot(node.normal(), node.parameters()));
  }
};

}  // namespace ALHAZEN_CORE
