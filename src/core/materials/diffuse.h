#pragma once

// Lambertian reflection, f = reflectance / pi, on both sides of the surface, without transmission.

#include "core/materials/closure.h"
#include "core/sampling/warp.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits diffuse_traits() {
  return {.has_lobes = false, .is_one_sided = true, .may_be_sharp = false};
}

template <class Real>
struct DiffuseRecord {
  TextureRange reflectance;
};

template <class Real>
struct DiffuseBsdf {
  Vec3<Real> reflectance;

  ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample(const Vec3<Real>& wo, Real, const Vec2<Real>& u) const {
    BsdfSample<Real> s;
    s.direction = sample_cosine_hemisphere(u);
    s.pdf = pdf_cosine_hemisphere(s.direction.z);
    s.weight = reflectance;
    if (wo.z < 0) s.direction.z = -s.direction.z;
    return s;
  }

  ALHAZEN_HD ALHAZEN_HOT BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
    if (!(wo.z * wi.z > 0)) return {};
    const Real pdf = pdf_cosine_hemisphere(std::abs(wi.z));
    return {reflectance * pdf, pdf};
  }

  ALHAZEN_HD Vec3<Real> albedo() const { return reflectance; }
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_HOT void make_closure(const DiffuseRecord<Real>& record, const Textures& textures,
                                         DiffuseBsdf<Real>& bsdf) {
  bsdf.reflectance = textures.colour(record.reflectance);
}

}  // namespace ALHAZEN_CORE
