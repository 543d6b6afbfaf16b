#pragma once

// Colours of vertices, interpolated over the mesh, and their fourth channel; 1 if the mesh has none.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct VertexColourTexture : TextureBase {
  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    return node.vertex_colour().rgb;
  }
};

struct VertexAlphaTexture : TextureBase {
  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    return splat(node.vertex_colour().alpha);
  }
};

}  // namespace ALHAZEN_CORE
