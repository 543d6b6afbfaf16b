#pragma once

// Functions of other textures: product, blend, one channel, and a step.

#include "core/textures/kinds/texture_base.h"

namespace ALHAZEN_CORE {

struct ScaleTexture : TextureBase {
  static constexpr uint32_t input_count = 2;  ///< factors

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node&, const Vec3<Real>* inputs) {
    return inputs[0] * inputs[1];
  }
};

struct MixTexture : TextureBase {
  static constexpr uint32_t input_count = 3;  ///< value at 0, value at 1, amount

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node&, const Vec3<Real>* inputs) {
    return inputs[0] * (splat(Real(1)) - inputs[2]) + inputs[1] * inputs[2];
  }
};

/// One channel of a texture in all three.
struct ChannelTexture : TextureBase {
  static constexpr uint32_t input_count = 1;

  template <class Description>
  static int number(const Description& texture) {
    return clamp(texture.channel, 0, 2);
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs) {
    return splat(inputs[0][static_cast<int>(node.number())]);
  }
};

/// 1 where a texture is at least the value, else 0.
struct ThresholdTexture : TextureBase {
  static constexpr uint32_t input_count = 1;

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs) {
    const auto step = [](Real x, Real edge) { return x >= edge ? Real(1) : Real(0); };
    const Vec3<Real> edge = node.parameters();
    return {step(inputs[0].x, edge.x), step(inputs[0].y, edge.y), step(inputs[0].z, edge.z)};
  }
};

}  // namespace ALHAZEN_CORE
