#pragma once

// Perlin noise summed over octaves: fbm, and wrinkled, which sums absolute values (turbulence).

#include "core/textures/kinds/texture_base.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

template <bool absolute>
struct OctaveNoiseTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::space;

  template <class Description>
  static Vec3d parameters(const Description& texture) {
    return {texture.roughness, 0, 0};
  }
  template <class Description>
  static int number(const Description& texture) {
    return clamp(texture.octaves, 1, 64);
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    return splat(octave_noise(node.permutation(), node.point(), node.parameters().x, node.number(), absolute));
  }
};

using FbmTexture = OctaveNoiseTexture<false>;
using WrinkledTexture = OctaveNoiseTexture<true>;

}  // namespace ALHAZEN_CORE
