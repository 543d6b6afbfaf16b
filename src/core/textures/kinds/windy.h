#pragma once

// Waves on water under wind: a product of two noises.

#include "core/textures/kinds/texture_base.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

/// Waves whose height is scaled by wind strength, a noise of lower frequency.
template <class Real>
ALHAZEN_HD Real windy_waves(const uint8_t* permutation, const Vec3<Real>& p) {
  const Real strength = octave_noise(permutation, p * Real(0.1), Real(0.5), 3, false);
  return std::abs(strength) * octave_noise(permutation, p, Real(0.5), 6, false);
}

struct WindyTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::space;

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    return splat(windy_waves(node.permutation(), node.point()));
  }
};

}  // namespace ALHAZEN_CORE
