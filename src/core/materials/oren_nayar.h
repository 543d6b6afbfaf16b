#pragma once

// Rough diffuse surfaces: the energy-preserving Oren-Nayar model of Portsmouth, Kutz and Hill 2025 ("EON: A Practical
// Energy-Preserving Rough Diffuse BRDF", JCGT 14(1)), sampled as in the paper by a mixture of a clipped linearly
// transformed cosine lobe and a uniform lobe. It is reciprocal, and conserves energy if the reflectance is 1.

#include "core/materials/closure.h"
#include "core/sampling/warp.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits oren_nayar_traits() { return {.is_one_sided = true, .may_be_sharp = false}; }

template <class Real>
struct OrenNayarRecord {
  TextureRange reflectance;
  TextureRange roughness;  ///< scalar; 0: Lambertian
};

template <class Real>
struct OrenNayarBsdf {
  Vec3<Real> reflectance;
  Vec3<Real> multiple;  ///< albedo of multiple scattering
  Real roughness;

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const;
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

/// Constants of the single-scattering albedo for reflectance 1 and roughness r: along the normal it is
/// 1 / (1 + normal * r), and its mean over all directions is (1 + mean * r) / (1 + normal * r).
template <class Real>
struct OrenNayarAlbedo {
  static constexpr Real normal = Real(0.5) - 2 * inv_pi<Real> / 3;
  static constexpr Real mean = Real(2) / 3 - 28 * inv_pi<Real> / 15;
};

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void make_closure(const OrenNayarRecord<Real>& record, const Textures& textures, const ClosureView<Real>&,
                             OrenNayarBsdf<Real>& b) {
  using Albedo = OrenNayarAlbedo<Real>;
  b.reflectance = textures.colour(record.reflectance);
  b.roughness = textures.scalar_or(record.roughness, Real(0));
  const Real mean = (1 + Albedo::mean * b.roughness) / (1 + Albedo::normal * b.roughness);
  b.multiple = b.reflectance * b.reflectance * mean / (splat(Real(1)) - b.reflectance * (1 - mean));
}

/// Returns 1 minus the directional albedo of single scattering, times (1 + Albedo::normal * r) / r, by the paper's fit.
template <class Real>
ALHAZEN_HD Real oren_nayar_missing(Real cosine) {
  const Real x = 1 - cosine;
  const Real gained =
      x * (Real(0.0571085289) + x * (Real(0.491881867) + x * (Real(-0.332181442) + x * Real(0.0714429953))));
  return max(Real(0), OrenNayarAlbedo<Real>::normal - gained);
}

template <class Real>
ALHAZEN_HD Vec3<Real> OrenNayarBsdf<Real>::albedo() const {
  const Real single = 1 / (1 + OrenNayarAlbedo<Real>::normal * roughness);
  return reflectance * single + multiple * (1 - single);
}

/// The sampling density: a cosine lobe transformed by the matrix ((a, 0, b), (0, c, 0), (d, 0, 1)), clipped to the
/// directions that this maps above the surface, mixed with a uniform lobe. `o` is in the plane of x > 0 and z.
template <class Real>
struct OrenNayarLobe {
  Real a, b, c, d;
  Real kept;          ///< fraction of the cosine lobe that is not clipped
  Real uniform_rate;  ///< probability of sampling the uniform lobe
  Real cosine, sine;  ///< of the azimuth of `o`
};

/// Evaluates the fits of the paper for `o.z` > 0 and roughness `r`.
template <class Real>
ALHAZEN_HD OrenNayarLobe<Real> oren_nayar_lobe(const Vec3<Real>& o, Real r) {
  const Real mu = min(o.z, Real(1)), mu3 = mu * mu * mu;
  OrenNayarLobe<Real> lobe;
  lobe.a = 1 + r * (Real(0.303392) + mu * (Real(-0.518982) + Real(0.111709) * mu) +
                    r * (Real(-0.276266) + Real(0.335918) * mu));
  lobe.b =
      r * (Real(-1.16407) + Real(1.15859) * mu + r * (Real(0.150815) - Real(0.150105) * mu)) / (mu3 - Real(1.43545));
  lobe.c = 1 + r * (Real(0.20013) + mu * (Real(-0.506373) + Real(0.261777) * mu));
  lobe.d = r * (Real(0.540852) + mu * (Real(-1.01625) + Real(0.475392) * mu)) /
           (Real(-1.0743) + mu * (Real(0.0725628) + mu));
  lobe.d = min(lobe.d, Real(0));  // rounding makes it positive near the normal
  lobe.kept = Real(0.5) * (1 + 1 / std::sqrt(1 + lobe.d * lobe.d));
  lobe.uniform_rate =
      std::pow(r, Real(0.1)) * (Real(0.162925) + mu * (Real(-0.372058) + mu * (Real(0.538233) - Real(0.290822) * mu)));
  const Real length = std::sqrt(o.x * o.x + o.y * o.y);
  lobe.cosine = length > 0 ? o.x / length : Real(1);
  lobe.sine = length > 0 ? o.y / length : Real(0);
  return lobe;
}

template <class Real>
ALHAZEN_HD Vec3<Real> sample_oren_nayar_lobe(const OrenNayarLobe<Real>& lobe, const Vec2<Real>& u) {
  const Vec2<Real> disk = sample_disk(u);
  const Real edge = safe_sqrt(1 - disk.y * disk.y);
  const Real x = -(edge + (disk.x - edge) * lobe.kept), z = safe_sqrt(1 - x * x - disk.y * disk.y);
  const Vec3<Real> w = normalize(Vec3<Real>{lobe.a * x + lobe.b * z, lobe.c * disk.y, lobe.d * x + z});
  return {lobe.cosine * w.x - lobe.sine * w.y, lobe.sine * w.x + lobe.cosine * w.y, w.z};
}

/// Returns the density of sample_oren_nayar_lobe at `i` with respect to solid angle.
template <class Real>
ALHAZEN_HD Real pdf_oren_nayar_lobe(const OrenNayarLobe<Real>& lobe, const Vec3<Real>& i) {
  const Real x = lobe.cosine * i.x + lobe.sine * i.y, y = lobe.cosine * i.y - lobe.sine * i.x;
  const Real minor = lobe.a - lobe.b * lobe.d, determinant = lobe.c * minor;
  const Vec3<Real> w{lobe.c * (x - lobe.b * i.z), minor * y, lobe.c * (lobe.a * i.z - lobe.d * x)};
  return sqr(determinant / length_squared(w)) * max(Real(0), w.z) * inv_pi<Real> / lobe.kept;
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> OrenNayarBsdf<Real>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  using Albedo = OrenNayarAlbedo<Real>;
  if (!(wo.z * wi.z > 0)) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Real along = o.x * i.x + o.y * i.y;
  const Real shape = along > 0 ? along / max(o.z, i.z) : along;
  const Real scale = i.z * inv_pi<Real> / (1 + Albedo::normal * roughness);
  const Real missing = oren_nayar_missing(o.z) * oren_nayar_missing(i.z) / (Albedo::normal - Albedo::mean);
  const OrenNayarLobe<Real> lobe = oren_nayar_lobe(o, roughness);
  return {(reflectance * (1 + roughness * shape) + multiple * (roughness * missing)) * scale,
          lobe.uniform_rate * Real(0.5) * inv_pi<Real> + (1 - lobe.uniform_rate) * pdf_oren_nayar_lobe(lobe, i)};
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> OrenNayarBsdf<Real>::sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const {
  if (wo.z == 0) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const OrenNayarLobe<Real> lobe = oren_nayar_lobe(wo * side, roughness);
  if (!(u_lobe < lobe.uniform_rate)) return evaluated_sample(*this, wo, sample_oren_nayar_lobe(lobe, u) * side);
  Vec3<Real> i = sample_uniform_sphere(u);
  i.z = std::abs(i.z);
  return evaluated_sample(*this, wo, i * side);
}

}  // namespace ALHAZEN_CORE
