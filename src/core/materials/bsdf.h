#pragma once

// The BSDF at a point: a closure of any kind in its shading frame. Each operation dispatches by a switch that expands
// from the lists of core/materials/material_list.h. Directions are in world space and point away from the surface.

#include <type_traits>

#include "core/materials/material_record.h"
#include "core/materials/texture_evaluator.h"
#include "core/math/frame.h"

namespace ALHAZEN_CORE {

#define ALHAZEN_KIND(name, Name) static_assert(ClosureOf<Name##Bsdf<float>, float>);
ALHAZEN_SCATTERING_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND

template <class Real>
struct Bsdf {
  MaterialKind kind;
  Frame<Real> frame;  ///< normal: the shading normal
  union {             ///< the closure of `kind`; not initialised, since some are large
#define ALHAZEN_KIND(name, Name) Name##Bsdf<Real> name;
    ALHAZEN_SCATTERING_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
  };

  ALHAZEN_HD Bsdf() {}
  ALHAZEN_HD Bsdf(MaterialKind kind_, const Frame<Real>& frame_) : kind(kind_), frame(frame_) {}

  /// Returns whether the BSDF is a sum of Dirac delta distributions, for which sampling lights is useless.
  ALHAZEN_HD ALHAZEN_HOT bool is_specular() const {
    switch (kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return name.is_specular();
      ALHAZEN_SCATTERING_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
      default:
        return false;
    }
  }

  /// Returns whether the BSDF never transmits light.
  ALHAZEN_HD ALHAZEN_HOT bool is_one_sided() const {
    if (has_trait<&MaterialTraits::is_one_sided>(kind)) return true;
    switch (kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return says_one_sided(name);
      ALHAZEN_SCATTERING_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
      default:
        return false;
    }
  }
};

template <class Real>
ALHAZEN_HD ALHAZEN_COLD void make_rare_bsdf(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                            const TexturePoint<Real>& at, const ClosureView<Real>& view,
                                            Bsdf<Real>& bsdf) {
  const TextureEvaluator<Real> textures{scene, at};
  switch (material.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return make_closure(material.name, textures, view, bsdf.name);
    ALHAZEN_RARE_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return;
  }
}

/// Returns the ClosureView of the hit that is shaded.
template <class Maker, class Real>
concept ClosureViewMaker = std::is_invocable_r_v < ClosureView<Real>,
const Maker& > ;

/// Makes the closure of a material by evaluating its textures; the frame is already set. Only rare kinds
/// need the view.
template <class Real, ClosureViewMaker<Real> View>
ALHAZEN_HD ALHAZEN_HOT void make_bsdf(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                      const TexturePoint<Real>& at, const View& view, Bsdf<Real>& bsdf) {
  const TextureEvaluator<Real> textures{scene, at};
  bsdf.kind = material.kind;
  switch (material.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return make_closure(material.name, textures, bsdf.name);
    ALHAZEN_FREQUENT_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return make_rare_bsdf(scene, material, at, view(), bsdf);
  }
}

/// In local coordinates.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfSample<Real> sample_rare_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                          const Vec2<Real>& u) {
  switch (bsdf.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return bsdf.name.sample(wo, u_lobe, u);
    ALHAZEN_RARE_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return {};
  }
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_local_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                          const Vec2<Real>& u) {
  switch (bsdf.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return bsdf.name.sample(wo, u_lobe, u);
    ALHAZEN_FREQUENT_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return sample_rare_bsdf(bsdf, wo, u_lobe, u);
  }
}

/// Samples an incident direction for light that leaves along `wo`. A pdf of 0 means that nothing was sampled.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                    const Vec2<Real>& u) {
  BsdfSample<Real> s = sample_local_bsdf(bsdf, bsdf.frame.to_local(wo), u_lobe, u);
  s.direction = bsdf.frame.to_world(s.direction);
  return s;
}

/// In local coordinates.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate_rare_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                           const Vec3<Real>& wi) {
  switch (bsdf.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return bsdf.name.evaluate(wo, wi);
    ALHAZEN_RARE_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return {};
  }
}

/// Evaluates f * |cos| for light from `wi` to `wo`, and the density of `sample_bsdf` with respect to solid angle. Both
/// are 0 for specular surfaces.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfValue<Real> evaluate_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                     const Vec3<Real>& wi) {
  const Vec3<Real> o = bsdf.frame.to_local(wo), i = bsdf.frame.to_local(wi);
  switch (bsdf.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return bsdf.name.evaluate(o, i);
    ALHAZEN_FREQUENT_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return evaluate_rare_bsdf(bsdf, o, i);
  }
}

/// Glass with an alpha up to this is seen through sharply.
inline constexpr double max_sharp_alpha = 0.01;

/// Returns whether a BSDF that is not specular transmits almost as if it were.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool transmits_sharply(const Bsdf<Real>& bsdf) {
  const auto is_sharp = [](const Vec2<Real>& alpha) { return max(alpha.x, alpha.y) <= Real(max_sharp_alpha); };
  switch (bsdf.kind) {
    case MaterialKind::dielectric:
      return bsdf.dielectric.alpha <= Real(max_sharp_alpha);
    case MaterialKind::anisotropic_dielectric:
      return is_sharp(bsdf.anisotropic_dielectric.alpha);
    case MaterialKind::principled: {
      const PrincipledBsdf<Real>& b = bsdf.principled;
      if (!is_zero(b.diffuse_through)) return false;  // directions of that lobe are not told apart
      return b.glass > 0 ? is_sharp(b.alpha) : !is_zero(b.through) && is_sharp(b.through_alpha);
    }
    default:
      return false;
  }
}

/// Returns which fraction of f(wo, wi), per channel, is of a diffuse lobe; the rest is glossy. Of layered materials
/// that is what they would reflect less without it.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD Vec3<Real> diffuse_fraction(const Bsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                    const Vec3<Real>& wi) {
  const Vec3<Real> o = bsdf.frame.to_local(wo), i = bsdf.frame.to_local(wi);
  const auto fraction = [&](const auto& whole, auto glossy) {
    glossy.diffuse = {};
    const Vec3<Real> f = whole.evaluate(o, i).value, rest = glossy.evaluate(o, i).value;
    const auto channel = [](Real all, Real part) {
      return all > 0 ? clamp(1 - part / all, Real(0), Real(1)) : Real(0);
    };
    return Vec3<Real>{channel(f.x, rest.x), channel(f.y, rest.y), channel(f.z, rest.z)};
  };
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
    case MaterialKind::oren_nayar:
    case MaterialKind::diffuse_transmission:
      return splat(Real(1));
    case MaterialKind::principled:
      return fraction(bsdf.principled, bsdf.principled);
    case MaterialKind::coated_diffuse:
      return fraction(bsdf.coated_diffuse, bsdf.coated_diffuse);
    default:
      return {};
  }
}

/// Returns an approximate albedo at normal incidence, as a guide for denoisers.
template <class Real>
ALHAZEN_HD Vec3<Real> bsdf_albedo(const Bsdf<Real>& bsdf) {
  switch (bsdf.kind) {
#define ALHAZEN_KIND(name, Name) \
  case MaterialKind::name:       \
    return bsdf.name.albedo();
    ALHAZEN_SCATTERING_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
    default:
      return splat(Real(1));
  }
}

}  // namespace ALHAZEN_CORE
