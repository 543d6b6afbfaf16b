#pragma once

// pbrt's marble: a uniform cubic Bezier spline through nine colours, indexed by veins that noise displaces
// (PBR 4th ed., 10.5; the colours are constants of pbrt-v4).

#include "core/textures/kinds/texture_base.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

struct MarbleTexture : TextureBase {
  static constexpr TextureDomain domain = TextureDomain::space;

  template <class Description>
  static Vec3d parameters(const Description& texture) {
    return {texture.roughness, texture.noise_scale, texture.variation};
  }
  template <class Description>
  static int number(const Description& texture) {
    return clamp(texture.octaves, 1, 64);
  }

  template <class Real>
  ALHAZEN_HD static Vec3<Real> colour(int i) {
    switch (i) {
      case 3:
        return {Real(0.5), Real(0.5), Real(0.5)};
      case 4:
        return {Real(0.6), Real(0.59), Real(0.58)};
      case 7:
        return {Real(0.2), Real(0.2), Real(0.33)};
      default:
        return {Real(0.58), Real(0.58), Real(0.6)};
    }
  }

  template <class Real, class Node>
  ALHAZEN_HD static Vec3<Real> evaluate(const Node& node, const Vec3<Real>*) {
    const Vec3<Real> parameters = node.parameters();
    const Vec3<Real> p = node.point() * parameters.y;
    const Real noise = octave_noise(node.permutation(), p, parameters.x, node.number(), false);
    const Real wave = sine_cosine(p.y + parameters.z * noise).sine;
    const Real t = wave > -2 ? Real(0.5) + Real(0.5) * wave : Real(0.5);  // wave is NaN if the point is infinite
    int first = static_cast<int>(t * 6);
    first = first > 5 ? 5 : first;
    const Real s = t * 6 - static_cast<Real>(first);
    const Vec3<Real> a = lerp(colour<Real>(first), colour<Real>(first + 1), s);
    const Vec3<Real> b = lerp(colour<Real>(first + 1), colour<Real>(first + 2), s);
    const Vec3<Real> c = lerp(colour<Real>(first + 2), colour<Real>(first + 3), s);
    return lerp(lerp(a, b, s), lerp(b, c, s), s) * Real(1.5);
  }
};

}  // namespace ALHAZEN_CORE
