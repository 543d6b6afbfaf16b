#pragma once

// A smooth, thin dielectric pane, whose two interfaces are one surface.

#include "core/materials/closure.h"
#include "core/materials/lobes/fresnel.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits thin_dielectric_traits() { return {}; }

template <class Real>
struct ThinDielectricRecord {
  Real ior;  ///< of the pane relative to its surroundings
};

template <class Real>
struct ThinDielectricBsdf {
  Real ior;

  /// Samples reflection with the probability R + T^2 R / (1 - R^2), the reflectance of both interfaces together.
  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>&) const {
    BsdfSample<Real> s;
    if (wo.z == 0) return s;
    Real cos_t;
    const Real once = fresnel_dielectric(std::abs(wo.z), ior, cos_t);
    const Real reflected = once < 1 ? once + sqr(1 - once) * once / (1 - once * once) : Real(1);
    s.specular = true;
    s.weight = splat(Real(1));
    if (u_lobe < reflected) {
      s.direction = {-wo.x, -wo.y, wo.z};
      s.pdf = reflected;
    } else {
      s.direction = -wo;
      s.pdf = 1 - reflected;
    }
    return s;
  }

  ALHAZEN_HD BsdfValue<Real> evaluate(const Vec3<Real>&, const Vec3<Real>&) const { return {}; }
  ALHAZEN_HD Vec3<Real> albedo() const { return splat(Real(1)); }
  ALHAZEN_HD constexpr bool is_specular() const { return true; }
};

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void make_closure(const ThinDielectricRecord<Real>& record, const Textures&, const ClosureView<Real>&,
                             ThinDielectricBsdf<Real>& bsdf) {
  bsdf.ior = record.ior;
}

}  // namespace ALHAZEN_CORE
