#pragma once

// Integrals over the microfacet normals of GGX that a direction sees, by midpoints of strata: what the tables and grids
// of albedo are computed by. `Alpha` is a number or a pair, as in core/materials/microfacet.h.

#include <algorithm>
#include <cmath>

#include "core/materials/albedo_table.h"
#include "core/materials/fresnel.h"
#include "core/materials/microfacet.h"

namespace alhazen {

/// The cosine of a node: the inverse of cosine_coordinate, a little inside of where there is no direction.
inline double cosine_at(uint32_t node, double ior, uint32_t nodes) {
  if (ior >= 1) return std::max(sqr(static_cast<double>(node) / (nodes - 1)), 1e-4);
  const uint32_t critical = critical_node(nodes);
  if (node > critical) {
    const double cos_t = sqr(static_cast<double>(node - critical) / (nodes - 1 - critical));
    return safe_sqrt(1 - ior * ior * (1 - cos_t * cos_t));
  }
  const double turn = pi<double> * node / critical;
  return std::max(0.5 * safe_sqrt(1 - ior * ior) * (1 - std::cos(turn)), 1e-4);
}

/// Mean of value(cosine) over all directions, weighted by the cosine. Below an index of 1 the directions that are
/// totally reflected and the others are taken apart: the latter may fill a small cone.
template <class Value>
double mean_over_cosines(double ior, const Value& value) {
  constexpr int steps = 256;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double x = (k + 0.5) / steps;
    if (ior >= 1) {
      // Midpoints by sqrt(cosine) = x: 2 cos d cos = 4 x^3 dx.
      sum += value(x * x) * 4 * x * x * x / steps;
      continue;
    }
    const double critical2 = 1 - ior * ior, cos2 = critical2 * (1 - (1 - x) * (1 - x));
    sum += value(std::sqrt(cos2)) * critical2 * 2 * (1 - x) / steps;
    // By x = sqrt(cosine of refraction), where 2 cos d cos = ior^2 4 x^3 dx.
    sum += value(safe_sqrt(1 - ior * ior * (1 - x * x * x * x))) * ior * ior * 4 * x * x * x / steps;
  }
  return sum;
}

/// Mean over all directions of what is looked up in a row of a table.
inline double mean_of_row(const double* row, double ior, uint32_t nodes) {
  return mean_over_cosines(ior, [&](double cosine) {
    const double place = cosine_coordinate(cosine, ior, nodes) * (nodes - 1);
    const uint32_t i = std::min(static_cast<uint32_t>(place), nodes - 2);
    return row[i] + (row[i + 1] - row[i]) * (place - i);
  });
}

/// How the square is cut into strata: evenly, or finer where normals are far from the mean. What these tails reflect
/// counts where the interface reflects much.
enum class Strata { even, dense_in_tails };

/// Calls visit(normal, weight) for the normals seen from `o`; the weights add up to 1.
template <class Alpha, class Visit>
void for_visible_normals(const Vec3d& o, const Alpha& alpha, int count, Strata strata, const Visit& visit) {
  for (int a = 0; a < count; ++a) {
    const double rest = 1 - (a + 0.5) / count;
    const double u = strata == Strata::even ? (a + 0.5) / count : 1 - rest * rest;
    const double weight = (strata == Strata::even ? 1 : 2 * rest) / (count * count);
    for (int b = 0; b < count; ++b) visit(sample_visible_normal(o, alpha, Vec2d{u, (b + 0.5) / count}), weight);
  }
}

/// Mean of share(normal) over the visible normals.
template <class Alpha, class Share>
double mean_over_visible_normals(const Vec3d& o, const Alpha& alpha, Strata strata, const Share& share,
                                 int count = 24) {
  double sum = 0, weights = 0;
  for_visible_normals(o, alpha, count, strata, [&](const Vec3d& m, double weight) {
    const double counted = strata == Strata::even ? 1 : weight;
    sum += counted * share(m), weights += counted;
  });
  return sum / weights;
}

/// Mean of weight(cosine at the microfacet, that of the reflected direction) over what GGX of that alpha reflects.
template <class Alpha, class Weight>
double reflected_share(const Vec3d& o, const Alpha& alpha, Strata strata, const Weight& weight, int count = 24) {
  return mean_over_visible_normals(
      o, alpha, strata,
      [&](const Vec3d& m) {
        const double cosine = dot(o, m);
        const Vec3d i = m * (2 * cosine) - o;
        return i.z > 0 && cosine > 0 ? weight(cosine, i.z) * ggx_g2(o, i, alpha) / ggx_g1(o, alpha) : 0;
      },
      count);
}

/// Cosine by which light from that cosine outside goes down through a coat. Where a smooth interface reflects
/// everything, below an index of 1, what a rough one lets in goes along it.
inline double cosine_in_coat(double cosine, double ior) {
  const double within = safe_sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  return ior < 1 ? std::max(within, 0.1) : within;
}

/// Share of light from `o` that single scattering at a rough interface lets through to what lies below a medium.
template <class Alpha>
double transmitted_share(const Vec3d& o, const Alpha& alpha, double ior, double optical_thickness, int count = 24) {
  return mean_over_visible_normals(
      o, alpha, Strata::even,
      [&](const Vec3d& m) {
        const double cosine = dot(o, m);
        double cos_t;
        const double passes = cosine > 0 ? 1 - fresnel_dielectric(cosine, ior, cos_t) : 0;
        if (passes == 0) return 0.0;
        const Vec3d i = m * (cosine / ior - cos_t) - o * (1 / ior);
        return i.z < 0 ? passes * std::exp(optical_thickness / i.z) * ggx_g2(o, i, alpha) / ggx_g1(o, alpha) : 0;
      },
      count);
}

}  // namespace alhazen
