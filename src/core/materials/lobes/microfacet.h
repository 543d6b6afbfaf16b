#pragma once

// The GGX distribution of microfacet normals (Trowbridge and Reitz 1975; Walter et al. 2007) and sampling of visible
// normals (Heitz 2018, JCGT 7(4)). Directions are in local coordinates, with z along the shading normal. `Alpha` is a
// scalar, or for anisotropic surfaces a pair: alpha along x (the tangent) and along y.

#include <concepts>
#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

/// Returns the alpha of a roughness from 0 to 1, as in pbrt-v4: alpha = sqrt(roughness) if `remap`, else the roughness.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real alpha_of_roughness(Real roughness, uint32_t remap) {
  return remap != 0 ? std::sqrt(roughness) : roughness;
}

/// Below this alpha a surface is treated as smooth.
template <class Real>
inline constexpr Real smooth_alpha = Real(1e-3);

template <class Real>
ALHAZEN_HD constexpr bool is_smooth(Real alpha) {
  return alpha < smooth_alpha<Real>;
}
template <class Real>
ALHAZEN_HD constexpr bool is_smooth(const Vec2<Real>& alpha) {
  return alpha.x < smooth_alpha<Real> && alpha.y < smooth_alpha<Real>;
}

/// Returns the alphas, clamped so that the surface is not treated as smooth.
template <class Real>
ALHAZEN_HD constexpr Vec2<Real> rough_alphas(Real u, Real v) {
  return {max(u, smooth_alpha<Real>), max(v, smooth_alpha<Real>)};
}

/// Returns the geometric mean, an isotropic approximation for terms that depend only weakly on alpha.
template <class Real>
ALHAZEN_HD Real mean_alpha(const Vec2<Real>& alpha) {
  return std::sqrt(alpha.x * alpha.y);
}

/// Scales x and y by alpha.
template <class Real>
ALHAZEN_HD constexpr Vec3<Real> stretch(const Vec3<Real>& v, Real alpha) {
  return {alpha * v.x, alpha * v.y, v.z};
}
template <class Real>
ALHAZEN_HD constexpr Vec3<Real> stretch(const Vec3<Real>& v, const Vec2<Real>& alpha) {
  return {alpha.x * v.x, alpha.y * v.y, v.z};
}

/// Evaluates the distribution of microfacet normals: the integral of ggx_d * cos over the hemisphere is 1.
template <class Real>
ALHAZEN_HD Real ggx_d(const Vec3<Real>& m, Real alpha) {
  const Real a2 = alpha * alpha;
  const Real d = m.z * m.z + (m.x * m.x + m.y * m.y) / a2;
  return 1 / (pi<Real> * a2 * d * d);
}

template <class Real>
ALHAZEN_HD Real ggx_d(const Vec3<Real>& m, const Vec2<Real>& alpha) {
  const Real d = m.z * m.z + sqr(m.x / alpha.x) + sqr(m.y / alpha.y);
  return 1 / (pi<Real> * alpha.x * alpha.y * d * d);
}

/// The alpha of a GGX distribution, or those along the tangent and the bitangent.
template <class Alpha, class Real>
concept AlphaOf = std::same_as<Alpha, Real> || std::same_as<Alpha, Vec2<Real>>;

template <class Real>
ALHAZEN_HD Real ggx_lambda(const Vec3<Real>& w, Real alpha) {
  const Real tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  return Real(0.5) * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

template <class Real>
ALHAZEN_HD Real ggx_lambda(const Vec3<Real>& w, const Vec2<Real>& alpha) {
  const Real slope2 = (sqr(alpha.x * w.x) + sqr(alpha.y * w.y)) / (w.z * w.z);
  return Real(0.5) * (std::sqrt(1 + slope2) - 1);
}

/// Returns the fraction of microfacets visible from `w` (Smith masking).
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real ggx_g1(const Vec3<Real>& w, const Alpha& alpha) {
  return w.z == 0 ? Real(0) : 1 / (1 + ggx_lambda(w, alpha));
}

/// Returns the fraction visible from both directions, by the height-correlated Smith model.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real ggx_g2(const Vec3<Real>& wo, const Vec3<Real>& wi, const Alpha& alpha) {
  if (wo.z == 0 || wi.z == 0) return 0;
  return 1 / (1 + ggx_lambda(wo, alpha) + ggx_lambda(wi, alpha));
}

/// Returns the density of `sample_visible_normal` at `m` with respect to solid angle.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real pdf_visible_normal(const Vec3<Real>& w, const Vec3<Real>& m, const Alpha& alpha) {
  return ggx_g1(w, alpha) / std::abs(w.z) * ggx_d(m, alpha) * max(Real(0), dot(w, m));
}

/// Samples a microfacet normal visible from `w`, with w.z > 0.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Vec3<Real> sample_visible_normal(const Vec3<Real>& w, const Alpha& alpha, const Vec2<Real>& u) {
  const Vec3<Real> stretched = normalize(stretch(w, alpha));
  const Real sin2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const Vec3<Real> t1 =
      sin2 > Real(1e-12) ? Vec3<Real>{-stretched.y, stretched.x, 0} * (1 / std::sqrt(sin2)) : Vec3<Real>{1, 0, 0};
  const Vec3<Real> t2 = cross(stretched, t1);
  Vec2<Real> p = sample_disk_polar(u);
  const Real h = safe_sqrt(1 - p.x * p.x), s = Real(0.5) * (1 + stretched.z);
  p.y = (1 - s) * h + s * p.y;
  const Real pz = safe_sqrt(1 - p.x * p.x - p.y * p.y);
  const Vec3<Real> n = t1 * p.x + t2 * p.y + stretched * pz;
  return normalize(stretch(Vec3<Real>{n.x, n.y, max(Real(1e-6), n.z)}, alpha));
}

template <class Real>
ALHAZEN_HD constexpr Real min_alpha(Real alpha) {
  return alpha;
}
template <class Real>
ALHAZEN_HD constexpr Real min_alpha(const Vec2<Real>& alpha) {
  return min(alpha.x, alpha.y);
}

/// Returns the factor on the lower end of the spherical cap from which microfacets are sampled, so that fewer of them
/// reflect below the surface.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real visible_reflection_bound(const Vec3<Real>& o, const Alpha& alpha) {
  const Real a2 = sqr(min_alpha(alpha)), s2 = sqr(1 + std::sqrt(o.x * o.x + o.y * o.y));
  return (1 - a2) * s2 / (s2 + a2 * o.z * o.z);
}

/// Returns the density of sample_ggx_reflection with respect to solid angle, divided by ggx_d of the microfacet, for
/// `o.z` > 0.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real ggx_reflection_density(const Vec3<Real>& o, const Alpha& alpha) {
  return Real(0.5) / (visible_reflection_bound(o, alpha) * o.z + length(stretch(o, alpha)));
}

/// GGX reflection without the Fresnel term: f * cos of `i`, and the density of sample_ggx_reflection at `i` with
/// respect to solid angle.
template <class Real>
struct GgxReflection {
  Real value = 0, pdf = 0;
  Real cosine = 0;  ///< between either direction and the microfacet normal
};

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD GgxReflection<Real> ggx_reflection(const Vec3<Real>& o, const Vec3<Real>& i, const Alpha& alpha) {
  GgxReflection<Real> r;
  if (!(o.z > 0 && i.z > 0)) return r;
  const Vec3<Real> m = normalize(o + i);
  const Real d = ggx_d(m, alpha);
  r.cosine = min(dot(o, m), Real(1));
  r.value = d * ggx_g2(o, i, alpha) / (4 * o.z);
  r.pdf = d * ggx_reflection_density(o, alpha);
  return r;
}

/// Samples a microfacet visible from `o`, with `o.z` > 0, among those that may reflect above the surface: a point of a
/// spherical cap (Dupuy and Benyoub 2023), bounded below (Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX
/// Reflections").
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Vec3<Real> sample_reflecting_normal(const Vec3<Real>& o, const Alpha& alpha, const Vec2<Real>& u) {
  const Vec3<Real> stretched = normalize(stretch(o, alpha));
  const Real z = 1 - u.x * (1 + visible_reflection_bound(o, alpha) * stretched.z), r = safe_sqrt(1 - z * z);
  const auto [sine, cosine] = sine_cosine_of_turn(2 * pi<Real> * u.y);
  const Vec3<Real> n{r * cosine + stretched.x, r * sine + stretched.y, max(Real(1e-6), z + stretched.z)};
  return normalize(stretch(n, alpha));
}

/// Samples the reflection of `o` at a visible microfacet.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Vec3<Real> sample_ggx_reflection(const Vec3<Real>& o, const Alpha& alpha, const Vec2<Real>& u) {
  const Vec3<Real> m = sample_reflecting_normal(o, alpha, u);
  return m * (2 * dot(o, m)) - o;
}

}  // namespace ALHAZEN_CORE
