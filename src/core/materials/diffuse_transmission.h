#pragma once

// A thin sheet with Lambertian reflection and transmission.

#include "core/materials/closure.h"
#include "core/sampling/warp.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits diffuse_transmission_traits() { return {.may_be_sharp = false}; }

template <class Real>
struct DiffuseTransmissionRecord {
  TextureRange reflectance, transmittance;
};

template <class Real>
struct DiffuseTransmissionBsdf {
  Vec3<Real> reflectance, transmittance;

  /// Returns the probability of sampling reflection.
  ALHAZEN_HD Real reflection_rate() const {
    const Real r = max_component(reflectance), t = max_component(transmittance);
    return r + t > 0 ? r / (r + t) : Real(1);
  }

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const {
    BsdfSample<Real> s;
    const Real rate = reflection_rate();
    const bool reflects = u_lobe < rate;
    const Real chosen = reflects ? rate : 1 - rate;
    if (!(chosen > 0)) return s;
    s.direction = sample_cosine_hemisphere(u);
    s.pdf = pdf_cosine_hemisphere(s.direction.z) * chosen;
    s.weight = (reflects ? reflectance : transmittance) / chosen;
    if ((wo.z < 0) == reflects) s.direction.z = -s.direction.z;
    return s;
  }

  ALHAZEN_HD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
    if (wo.z * wi.z == 0) return {};
    const bool reflects = wo.z * wi.z > 0;
    const Real pdf = pdf_cosine_hemisphere(std::abs(wi.z)), rate = reflection_rate();
    return {(reflects ? reflectance : transmittance) * pdf, pdf * (reflects ? rate : 1 - rate)};
  }

  ALHAZEN_HD Vec3<Real> albedo() const { return reflectance + transmittance; }
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void make_closure(const DiffuseTransmissionRecord<Real>& record, const Textures& textures,
                             const ClosureView<Real>&, DiffuseTransmissionBsdf<Real>& bsdf) {
  bsdf.reflectance = textures.colour_or(record.reflectance, Real(0));
  bsdf.transmittance = textures.colour_or(record.transmittance, Real(0));
  // Reflectance and transmittance must not sum to more than 1.
  const Vec3<Real> both = max(bsdf.reflectance + bsdf.transmittance, splat(Real(1)));
  bsdf.reflectance = bsdf.reflectance / both;
  bsdf.transmittance = bsdf.transmittance / both;
}

}  // namespace ALHAZEN_CORE
