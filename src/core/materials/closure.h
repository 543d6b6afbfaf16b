#pragma once

// The interface that all kinds of material implement: their traits, and the arguments and results of their closures. A
// closure is a material with its textures evaluated at a point. Directions are in local coordinates, with z along the
// shading normal, and point away from the surface.

#include <concepts>
#include <cstdint>

#include "core/math/frame.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

/// Static properties of a kind of material, returned by a function in the file of that kind.
struct MaterialTraits {
  bool has_lobes = true;       ///< uses a random number to select a lobe before it samples a direction
  bool is_one_sided = false;   ///< never transmits light; a closure may have a function of that name instead
  bool may_be_sharp = true;    ///< may scatter into a single direction, or nearly so
  bool is_bare_metal = false;  ///< is a conductor without a coat
};

template <class Real>
struct BsdfSample {
  Vec3<Real> direction{};
  Vec3<Real> weight{};    ///< f * |cos| / pdf; its limit for a specular direction
  Real pdf = 0;           ///< with respect to solid angle; no meaning if specular; 0: nothing was sampled
  Real eta = 1;           ///< index of the far side relative to this side if transmitted, else 1
  uint32_t specular = 0;  ///< 1: the direction follows a Dirac delta distribution
};

/// f * |cos|, and the density with which `sample` returns the direction, with respect to solid angle.
template <class Real>
struct BsdfValue {
  Vec3<Real> value{};
  Real pdf = 0;
};

/// Evaluates textures at the point that is shaded, as TextureEvaluator does.
template <class Textures, class Real>
concept TexturesOf = requires(const Textures& textures, TextureRange range, Real fallback, uint32_t remap) {
  { textures.value(range) } -> std::same_as<Vec3<Real>>;
  { textures.colour(range) } -> std::same_as<Vec3<Real>>;
  { textures.colour_or(range, fallback) } -> std::same_as<Vec3<Real>>;
  { textures.scalar_or(range, fallback) } -> std::same_as<Real>;
  { textures.alpha(range, remap) } -> std::same_as<Real>;
  { textures.layered_alphas(range, range, remap) } -> std::same_as<Vec2<Real>>;
};

/// A closure samples a direction (`u_lobe` selects a lobe) and evaluates a pair of directions. It has an albedo, for
/// denoisers, and may consist of Dirac delta distributions alone.
template <class Closure, class Real>
concept ClosureOf = requires(const Closure& closure, const Vec3<Real>& wo, const Vec3<Real>& wi, Real u_lobe,
                             const Vec2<Real>& u) {
  { closure.sample(wo, u_lobe, u) } -> std::same_as<BsdfSample<Real>>;
  { closure.evaluate(wo, wi) } -> std::same_as<BsdfValue<Real>>;
  { closure.albedo() } -> std::same_as<Vec3<Real>>;
  { closure.is_specular() } -> std::same_as<bool>;
};

/// Returns whether the closure never transmits light, if it says so itself and not by the traits of its kind.
template <class Closure>
ALHAZEN_HD ALHAZEN_HOT bool says_one_sided(const Closure& closure) {
  if constexpr (requires { closure.is_one_sided(); })
    return closure.is_one_sided();
  else
    return false;
}

/// Returns the sample for `wi`, drawn from one of the lobes, with the weight and the pdf of all lobes together.
template <class Real, ClosureOf<Real> Closure>
ALHAZEN_HD BsdfSample<Real> evaluated_sample(const Closure& closure, const Vec3<Real>& wo, const Vec3<Real>& wi) {
  BsdfSample<Real> s;
  const BsdfValue<Real> v = closure.evaluate(wo, wi);
  if (!(v.pdf > 0)) return s;
  s.direction = wi;
  s.pdf = v.pdf;
  s.weight = v.value / v.pdf;
  return s;
}

/// View-dependent arguments of the rare kinds whose closure needs them.
template <class Real>
struct ClosureView {
  Vec3<Real> wo;           ///< local outgoing direction
  Real u_channel;          ///< random number that selects a colour channel for dispersion
  Vec3<Real> coat_normal;  ///< local; differs from z if a normal map perturbs only the base, or the coat differently
};

/// Returns the terms of a layered closure that depend only on the outgoing direction `wo`. Closures store those for the
/// direction from which the surface is seen (`seen_from`), since light sampling and BSDF sampling both need them; those
/// for other directions are computed into `others`.
template <class Closure, class Real, class Lobes>
ALHAZEN_HD ALHAZEN_HOT const Lobes& lobes_for(const Closure& closure, const Vec3<Real>& wo, Lobes& others) {
  if (ALHAZEN_UNLIKELY(!(wo == closure.seen_from))) {
    others = lobes_of(closure, wo);
    return others;
  }
  return closure.lobes;
}

/// Returns the frame about the normal of a coat, for directions that were multiplied by `side` to be above the surface.
template <class Real>
ALHAZEN_HD Frame<Real> coat_frame(const Vec3<Real>& coat_normal, Real side) {
  return frame_about(Vec3<Real>{coat_normal.x * side, coat_normal.y * side, coat_normal.z});
}

}  // namespace ALHAZEN_CORE
