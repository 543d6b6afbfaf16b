#pragma once

// Metal below a rough dielectric coat, as a single lobe. Light that the metal reflects once leaves the coat in
// approximately a GGX lobe, whose alpha combines both roughnesses and the refraction. The fractions that leave after
// one reflection and after any number are tabulated by a simulation of the layers
// (compile/tables/coated_metal_tables.cpp).

#include "core/materials/lobes/albedo_table.h"
#include "core/materials/lobes/fresnel.h"

namespace ALHAZEN_CORE {

/// Nodes of a row, by cosine_coordinate, and of each roughness, coat or metal, that varies, by alpha_coordinate.
inline constexpr uint32_t coated_metal_cosines = albedo_side, coated_metal_alphas = 8;
/// A block has two rows: factors for light that the metal reflects once, and for all light if the metal reflects the
/// fraction `coated_metal_fit` at each further bounce. A geometric series fitted to both covers other reflectances.
template <class Real>
inline constexpr Real coated_metal_fit = Real(0.8);
inline constexpr uint32_t coated_metal_block = 2 * coated_metal_cosines;

/// Location in a table; the step of a constant roughness is 0.
template <class Real>
struct CoatedMetalPlace {
  const Real* block;
  uint32_t coat_step, metal_step;
  Real coat_weight, metal_weight;  ///< interpolation weights of the next block
  Real ior;                        ///< of the coat
};

template <class Real>
ALHAZEN_HD uint32_t coated_metal_step(Real alpha, Real& weight) {
  uint32_t i;
  weight = node_weight(alpha_coordinate(alpha), coated_metal_alphas, i);
  return i;
}

/// Locates a pair of alphas. Blocks are ordered by the roughness of the coat, then by that of the metal.
template <class Real>
ALHAZEN_HD CoatedMetalPlace<Real> coated_metal_place(const Real* table, bool coat_varies, bool metal_varies, Real coat,
                                                     Real metal, Real ior) {
  CoatedMetalPlace<Real> place{table, 0, 0, 0, 0, ior};
  if (metal_varies) {
    place.metal_step = coated_metal_block;
    place.block += coated_metal_step(metal, place.metal_weight) * place.metal_step;
  }
  if (coat_varies) {
    place.coat_step = coated_metal_block * (metal_varies ? coated_metal_alphas : 1);
    place.block += coated_metal_step(coat, place.coat_weight) * place.coat_step;
  }
  return place;
}

/// Returns the alpha of the lobe outside the coat. Refraction scales the slopes of the metal by the index; the slopes
/// of the coat contribute (ior - 1) / 2 of theirs on entry and again on exit.
template <class Real>
ALHAZEN_HD Real coated_metal_alpha(Real coat, Real metal, Real ior) {
  return min(Real(1), std::sqrt(sqr(ior * metal) + Real(0.5) * sqr((ior - 1) * coat)));
}

template <class Real>
ALHAZEN_HD Real coated_metal_value(const Real* row, Real cosine, Real ior) {
  const Real x = cosine_coordinate(cosine, ior, coated_metal_cosines) * static_cast<Real>(coated_metal_cosines - 1);
  uint32_t i = static_cast<uint32_t>(x);
  i = i > coated_metal_cosines - 2 ? coated_metal_cosines - 2 : i;
  return row[i] + (row[i + 1] - row[i]) * (x - static_cast<Real>(i));
}

/// Factors on the lobe for one of its two directions.
template <class Real>
struct CoatedMetalFactors {
  Real once, all;
};

template <class Real>
ALHAZEN_HD CoatedMetalFactors<Real> coated_metal_factors(const CoatedMetalPlace<Real>& place, Real cosine) {
  CoatedMetalFactors<Real> sum{0, 0};
  for (uint32_t corner = 0; corner < 4; ++corner) {
    const Real weight = (corner & 1 ? place.metal_weight : 1 - place.metal_weight) *
                        (corner & 2 ? place.coat_weight : 1 - place.coat_weight);
    if (!(weight > 0)) continue;
    const Real* row = place.block + (corner & 1 ? place.metal_step : 0) + (corner & 2 ? place.coat_step : 0);
    sum.once += weight * coated_metal_value(row, cosine, place.ior);
    sum.all += weight * coated_metal_value(row + coated_metal_cosines, cosine, place.ior);
  }
  return sum;
}

/// Returns the factor on the lobe for metal of this reflectance, by which each further bounce is multiplied once more.
template <class Real>
ALHAZEN_HD Vec3<Real> coated_metal_colour(const CoatedMetalFactors<Real>& o, const CoatedMetalFactors<Real>& i,
                                          const Vec3<Real>& reflectance) {
  const Real once = o.once * i.once, all = o.all * i.all;
  // Upper bound of the fraction reflected back to the metal; closer to 1, the series of white metal would diverge.
  constexpr Real max_again = Real(0.9);
  const Real again = all > 0 ? clamp((1 - once / all) / coated_metal_fit<Real>, Real(0), max_again) : Real(0);
  const auto channel = [&](Real c) { return once * c / max(Real(1e-6), 1 - again * c); };
  return {channel(reflectance.x), channel(reflectance.y), channel(reflectance.z)};
}

}  // namespace ALHAZEN_CORE
