#pragma once

// What the kinds of material share: what they say of themselves, what their closures take and return. A closure is a
// material with its textures evaluated at a point. Local coordinates: z along the shading normal, both directions
// pointing away from the surface.

#include <cstdint>

#include "core/math/frame.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// What a kind of material says of itself, by a function in its file.
struct MaterialTraits {
  bool has_lobes = true;       ///< samples a lobe by a random number before a direction
  bool is_one_sided = false;   ///< known never to let light through; false is always right
  bool may_be_sharp = true;    ///< may scatter into (nearly) a single direction
  bool is_bare_metal = false;  ///< reflects by metal alone
};

template <class Real>
struct BsdfSample {
  Vec3<Real> direction{};
  Vec3<Real> weight{};    ///< f * |cos| / pdf; for a specular direction the limit of that
  Real pdf = 0;           ///< over solid angle; of no meaning where specular; 0: nothing was sampled
  Real eta = 1;           ///< index beyond the surface relative to this side if transmitted, else 1
  uint32_t specular = 0;  ///< 1: light is sent in single directions alone
};

/// f * |cos| and the density with which `sample` would have returned the direction.
template <class Real>
struct BsdfValue {
  Vec3<Real> value{};
  Real pdf = 0;
};

/// The sample of a direction that a lobe was sampled for, by what all lobes together say of it.
template <class Closure, class Real>
ALHAZEN_HD BsdfSample<Real> evaluated_sample(const Closure& closure, const Vec3<Real>& wo, const Vec3<Real>& wi) {
  BsdfSample<Real> s;
  const BsdfValue<Real> v = closure.evaluate(wo, wi);
  if (!(v.pdf > 0)) return s;
  s.direction = wi;
  s.pdf = v.pdf;
  s.weight = v.value / v.pdf;
  return s;
}

/// From where a surface is seen, for the rare kinds whose closure depends on that.
template <class Real>
struct ClosureView {
  Real cosine;             ///< of the outgoing direction to the shading normal, negative from behind
  Real u_channel;          ///< a random number that chooses a colour channel for dispersion
  Vec3<Real> coat_normal;  ///< local; differs from z where the base is bent by a map and the coat is not
};

/// The frame about a coat's normal, where both directions were multiplied by `side` to lie above the surface.
template <class Real>
ALHAZEN_HD Frame<Real> coat_frame(const Vec3<Real>& coat_normal, Real side) {
  return frame_about(Vec3<Real>{coat_normal.x * side, coat_normal.y * side, coat_normal.z});
}

}  // namespace ALHAZEN_CORE
