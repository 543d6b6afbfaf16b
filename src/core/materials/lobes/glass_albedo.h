#pragma once

// The light that single scattering at rough glass loses, from grids, and a lobe that adds it. Single scattering has the
// largest term of shadowing and masking that is reciprocal and that visible normals sample exactly: the smaller of the
// masking G1 of both directions, as if the heights of the microfacets seen from both were fully correlated. So a
// sampled microfacet is kept with the probability min(1, G1(i) / G1(o)), as by the rule of Metropolis and Hastings.
// This keeps light straight where the index approaches 1. What is lost, mostly light that is reflected within the
// denser side, is added by a lobe after Kulla and Conty (2017, "Revisiting Physically Based Shading at Imageworks"),
// which reflects and transmits. It is sampled where a microfacet is not kept, by its own shape, so every sample of
// glass has the same weight, and none is lost.

#include "core/materials/lobes/albedo_grid.h"
#include "core/sampling/hash.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

/// Quantities in an AlbedoGrid of glass, first from outside, then the same from within. If the reflectance of
/// microfacets is c + s * F, with the Fresnel reflectance F, and 1 on total internal reflection, then the missing
/// fraction is missing - c * by_constant - (s - 1) * by_fresnel. Between the nodes of a row, these are linear in the
/// squared cosine.
struct GlassGrid {
  static constexpr uint32_t missing = 0;     ///< what single scattering loses
  static constexpr uint32_t cumulative = 1;  ///< integral of `missing` over the squared cosines below that of a node
  static constexpr uint32_t by_constant = 2, by_fresnel = 3;
  static constexpr uint32_t from_within = 4;
  static constexpr uint32_t count = 8;
};

/// A direction located in a grid of glass.
template <class Real>
struct GlassGridDirection {
  uint32_t first;  ///< of the quantities of the side
  GridDirection<Real> direction;
};

/// Returns the index beyond the interface relative to the side of a direction.
template <class Real>
ALHAZEN_HD Real index_beyond(Real ior, bool within) {
  return within ? 1 / ior : ior;
}

/// `ior` is the index inside relative to outside.
template <class Real>
ALHAZEN_HD GlassGridDirection<Real> glass_direction(const AlbedoGridPlace<Real>& grid, Real ior, const Vec3<Real>& w) {
  const bool within = w.z < 0;
  const Real beyond = index_beyond(ior, within);
  GridDirection<Real> d{0, 0, 0, 0};
  node_weight(cosine_coordinate(std::abs(w.z), beyond, grid_cosines), grid_cosines, d.node);
  const Real low = squared_cosine_of_node(d.node, beyond, grid_cosines);
  const Real high = squared_cosine_of_node(d.node + 1, beyond, grid_cosines);
  d.weight = high > low ? clamp((w.z * w.z - low) / (high - low), Real(0), Real(1)) : Real(0);
  locate_azimuth(grid, w.x, w.y, d);
  return {within ? GlassGrid::from_within : 0, d};
}

/// Returns the fraction of light that single scattering loses.
template <class Real>
ALHAZEN_HD Real glass_missing(const AlbedoGridPlace<Real>& grid, const GlassGridDirection<Real>& d) {
  return grid_albedo(grid, d.first + GlassGrid::missing, d.direction);
}

/// Returns the integral of the missing fraction, at one azimuth, over the squared cosines below that of `node`.
template <class Real>
ALHAZEN_HD Real glass_missing_below(const AlbedoGridPlace<Real>& grid, const GlassGridDirection<Real>& d,
                                    uint32_t node) {
  const uint32_t cell = node > 0 ? node - 1 : 0;
  return grid_albedo(
      grid, d.first + GlassGrid::cumulative,
      GridDirection<Real>{cell, d.direction.azimuth, static_cast<Real>(node - cell), d.direction.azimuth_weight});
}

/// Returns the mean over all directions of the Fresnel reflectance from the thinner side (the fit of Kulla and Conty
/// 2017).
template <class Real>
ALHAZEN_HD Real mean_fresnel(Real ior) {
  const Real eta = ior < 1 ? 1 / ior : ior;
  return (eta - 1) / (Real(4.08567) + Real(1.00071) * eta);
}

/// The lobe for light that leaves on one side. It sends light from each side in proportion to m |cos| / pi, where m is
/// the missing fraction, and its albedo is m.
template <class Real>
struct GlassLobe {
  Real reflected;            ///< fraction of its light that it reflects
  Real mean, mean_opposite;  ///< cosine-weighted means of m on this side and on the other
};

/// `within`: light leaves on the inner side. Reciprocity demands that as much light crosses in both directions, so each
/// side transmits at most what the other side misses, the mean missing fractions being weighted by the squared indices.
/// Less crosses if microfacets reflect: missing light scatters at least twice, and is not transmitted if it is
/// reflected each time.
template <class Real>
ALHAZEN_HD GlassLobe<Real> glass_lobe(const AlbedoGridPlace<Real>& grid, Real ior, bool within) {
  const Real outside = grid_mean(grid, GlassGrid::cumulative);
  const Real inside = grid_mean(grid, GlassGrid::from_within + GlassGrid::cumulative);
  GlassLobe<Real> lobe;
  lobe.mean = within ? inside : outside, lobe.mean_opposite = within ? outside : inside;
  const Real weighted_opposite = lobe.mean_opposite * sqr(index_beyond(ior, within));
  const Real crossing = 1 - sqr(mean_fresnel(ior));
  lobe.reflected = 1 - (weighted_opposite < lobe.mean ? crossing * (weighted_opposite / lobe.mean) : crossing);
  return lobe;
}

/// Density of the lobe, and f * |cos| without the change of radiance by refraction. They differ only if the surface is
/// anisotropic.
template <class Real>
struct GlassMultiple {
  Real value, pdf;
};

/// Evaluates the lobe towards `wi`, for light of which all is missing.
template <class Real>
ALHAZEN_HD GlassMultiple<Real> evaluate_glass_lobe(const AlbedoGridPlace<Real>& grid, Real ior,
                                                   const GlassLobe<Real>& lobe, const Vec3<Real>& wi, bool reflects) {
  constexpr Real least = Real(1e-30);
  const GlassGridDirection<Real> i = glass_direction(grid, ior, wi);
  const Real sent =
      (reflects ? lobe.reflected : 1 - lobe.reflected) * glass_missing(grid, i) * std::abs(wi.z) * inv_pi<Real>;
  const Real mean = reflects ? lobe.mean : lobe.mean_opposite;
  if (grid.azimuths == 1) return {sent / max(mean, least), sent / max(mean, least)};
  return {sent / max(mean, least), sent / max(glass_missing_below(grid, i, grid_cosines - 1), least)};
}

/// Makes two uniform numbers from the bits of a pair, which was used for another purpose.
template <class Real>
ALHAZEN_HD Vec2<Real> further_numbers(const Vec2<Real>& u) {
  constexpr Real scale = Real(0x1p24);
  const uint32_t x = combine32(static_cast<uint32_t>(u.x * scale), static_cast<uint32_t>(u.y * scale));
  return {unit_interval<Real>(x), unit_interval<Real>(mix32(x + 0x9e3779b9u))};
}

/// Samples the lobe for light that leaves along `wo`: the azimuth uniformly, and the squared cosine by the density that
/// is linear between the nodes.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_glass_lobe(const AlbedoGridPlace<Real>& grid, Real ior, const Vec3<Real>& wo, Real u_side,
                                        const Vec2<Real>& u) {
  const bool reflects = u_side < glass_lobe(grid, ior, wo.z < 0).reflected, within = (wo.z < 0) == reflects;
  const auto [sine, cosine] = sine_cosine_of_turn(2 * pi<Real> * u.y);
  GlassGridDirection<Real> d{within ? GlassGrid::from_within : 0, {0, 0, 0, 0}};
  locate_azimuth(grid, cosine, sine, d.direction);
  const Real target = u.x * glass_missing_below(grid, d, grid_cosines - 1);
  uint32_t node = 0;  // the last one whose integral is not above the target
  for (uint32_t step = grid_cosines / 2; step > 0; step /= 2)
    if (node + step < grid_cosines - 1 && glass_missing_below(grid, d, node + step) <= target) node += step;
  const Real below = glass_missing_below(grid, d, node), above = glass_missing_below(grid, d, node + 1);
  d.direction.node = node;
  const Real low = glass_missing(grid, d);
  d.direction.weight = 1;
  const Real high = glass_missing(grid, d);
  const Real part = above > below ? clamp((target - below) / (above - below), Real(0), Real(1)) : Real(0);
  // Solves low t + (high - low) t^2 / 2 = part (low + high) / 2.
  const Real root = low + safe_sqrt(low * low + part * (high * high - low * low));
  const Real t = root > 0 ? min(part * (low + high) / root, Real(1)) : part;
  const Real beyond = index_beyond(ior, within);
  const Real first = squared_cosine_of_node(node, beyond, grid_cosines);
  const Real squared = first + t * (squared_cosine_of_node(node + 1, beyond, grid_cosines) - first);
  const Real z = safe_sqrt(squared), r = safe_sqrt(1 - squared);
  return {r * cosine, r * sine, within ? -z : z};
}

}  // namespace ALHAZEN_CORE
