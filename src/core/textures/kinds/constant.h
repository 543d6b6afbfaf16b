#pragma once

// One value everywhere.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct ConstantTexture : TextureBase {
  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    return node.parameters();
  }
};

}  // namespace ALHAZEN_CORE
