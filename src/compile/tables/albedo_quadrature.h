#pragma once

// Integrals over the GGX microfacet normals visible from a direction, from which the albedo tables and grids are
// computed.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/materials/lobes/albedo_table.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"

namespace alhazen::impl {

/// The cosine of a node, moved slightly inside where the direction would be undefined.
inline double cosine_at(uint32_t node, double ior, uint32_t nodes) {
  return std::max(safe_sqrt(squared_cosine_of_node(node, ior, nodes)), 1e-4);
}

/// The inverse of alpha_coordinate, at a node.
inline double alpha_at(uint32_t node, uint32_t nodes) {
  if (node == 0) return min_layered_alpha<double>;
  const double root_of_min = std::sqrt(min_layered_alpha<double>);
  return std::min(1.0, sqr(root_of_min + (1 - root_of_min) * node / (nodes - 1)));
}

/// Mean of value(cosine) over all directions, weighted by the cosine. Below an index of 1, totally reflected directions
/// and the others are integrated separately: the latter may fill a small cone.
template <class Value>
double mean_over_cosines(double ior, const Value& value) {
  constexpr int steps = 256;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double x = (k + 0.5) / steps;
    if (ior >= 1) {
      // Midpoints in x = sqrt(cosine): 2 cos d cos = 4 x^3 dx.
      sum += value(x * x) * 4 * x * x * x / steps;
      continue;
    }
    const double critical2 = 1 - ior * ior, cos2 = critical2 * (1 - (1 - x) * (1 - x));
    sum += value(std::sqrt(cos2)) * critical2 * 2 * (1 - x) / steps;
    // Substitutes x = sqrt(cosine of refraction), where 2 cos d cos = ior^2 4 x^3 dx.
    sum += value(safe_sqrt(1 - ior * ior * (1 - x * x * x * x))) * ior * ior * 4 * x * x * x / steps;
  }
  return sum;
}

/// Mean over all directions of the values interpolated in a row of a table.
inline double mean_of_row(const double* row, double ior, uint32_t nodes) {
  return mean_over_cosines(ior, [&](double cosine) {
    const double place = cosine_coordinate(cosine, ior, nodes) * (nodes - 1);
    const uint32_t i = std::min(static_cast<uint32_t>(place), nodes - 2);
    return row[i] + (row[i + 1] - row[i]) * (place - i);
  });
}

/// Weighting of the disk from which normals are sampled: evenly, or with more points where normals are far from the
/// mean. The reflection of these tails matters if the interface reflects strongly.
enum class Density { even, dense_in_tails };

/// Normals visible from a direction, with weights that add up to 1. They are those of sample_visible_normal for points
/// that are the same for all directions: a Fibonacci lattice, which is less disturbed by a kink in the integrand, such
/// as at the horizon, than a square grid of as many points.
class VisibleNormals {
 public:
  /// A batch of normals that is in memory at once.
  struct Batch {
    static constexpr size_t max_count = 64;
    size_t count;
    double x[max_count], y[max_count], z[max_count];
    const double* weight;
  };

  VisibleNormals(size_t count, Density density) : x_(count), y_(count), height_(count), weight_(count) {
    constexpr double golden = 0.61803398874989485;
    double sum = 0;
    for (size_t k = 0; k < count; ++k) {
      const double rest = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      const double turn = static_cast<double>(k) * golden + 0.25, angle = 2 * pi<double> * (turn - std::floor(turn));
      const double radius = density == Density::even ? std::sqrt(1 - rest) : std::sqrt(1 - rest * rest);
      x_[k] = radius * std::cos(angle), y_[k] = radius * std::sin(angle);
      height_[k] = safe_sqrt(1 - x_[k] * x_[k]);
      sum += weight_[k] = density == Density::even ? 1 : rest;
    }
    for (double& weight : weight_) weight /= sum;
  }

  /// Calls visit(batch) for all batches.
  template <class Visit>
  void for_batches(const Vec3d& o, const Vec2d& alpha, const Visit& visit) const {
    const Vec3d stretched = normalize(stretch(o, alpha));
    const double sin2 = stretched.x * stretched.x + stretched.y * stretched.y;
    const Vec3d t1 = sin2 > 1e-12 ? Vec3d{-stretched.y, stretched.x, 0} * (1 / std::sqrt(sin2)) : Vec3d{1, 0, 0};
    const Vec3d t2 = cross(stretched, t1);
    const double up = 0.5 * (1 + stretched.z);
    Batch batch;
    for (size_t first = 0; first < x_.size(); first += batch.count) {
      batch.count = std::min(Batch::max_count, x_.size() - first);
      batch.weight = weight_.data() + first;
      const double *x = x_.data() + first, *y = y_.data() + first, *height = height_.data() + first;
      for (size_t k = 0; k < batch.count; ++k) {
        const double py = (1 - up) * height[k] + up * y[k];
        const double pz = safe_sqrt(height[k] * height[k] - py * py);
        const double nx = alpha.x * (t1.x * x[k] + t2.x * py + stretched.x * pz);
        const double ny = alpha.y * (t1.y * x[k] + t2.y * py + stretched.y * pz);
        const double nz = max(1e-6, t2.z * py + stretched.z * pz);
        const double scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
        batch.x[k] = nx * scale, batch.y[k] = ny * scale, batch.z[k] = nz * scale;
      }
      visit(batch);
    }
  }

  /// Calls visit(normal, weight) for all normals.
  template <class Visit>
  void for_each(const Vec3d& o, const Vec2d& alpha, const Visit& visit) const {
    for_batches(o, alpha, [&](const Batch& batch) {
      for (size_t k = 0; k < batch.count; ++k) visit(Vec3d{batch.x[k], batch.y[k], batch.z[k]}, batch.weight[k]);
    });
  }

 private:
  std::vector<double> x_, y_, height_, weight_;
};

/// The unshadowed fraction of what visible microfacets send from `o` to another direction: G2 / G1.
class UnshadowedFraction {
 public:
  UnshadowedFraction(const Vec3d& o, const Vec2d& alpha) : alpha_(alpha), lambda_(ggx_lambda(o, alpha)) {}
  double operator()(const Vec3d& i) const {
    return i.z == 0 ? 0.0 : (1 + lambda_) / (1 + lambda_ + ggx_lambda(i, alpha_));
  }
  /// Takes a direction by its squared coordinates, the tangential ones times alpha^2, and its cosine, which is above 0.
  double by_squares(double stretched2, double cosine) const {
    return (1 + lambda_) * cosine / ((0.5 + lambda_) * cosine + 0.5 * std::sqrt(cosine * cosine + stretched2));
  }

 private:
  Vec2d alpha_;
  double lambda_;
};

/// Mean of weight(cosine at the microfacet, cosine of the reflected direction) over the reflection of GGX with that
/// alpha.
template <class Weight>
double reflected_fraction(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, const Weight& weight) {
  const UnshadowedFraction unshadowed(o, alpha);
  double sum = 0;
  normals.for_each(o, alpha, [&](const Vec3d& m, double weight_of_normal) {
    const double cosine = dot(o, m);
    const Vec3d i = m * (2 * cosine) - o;
    if (i.z > 0 && cosine > 0) sum += weight_of_normal * weight(cosine, i.z) * unshadowed(i);
  });
  return sum;
}

/// Cosine at which light arriving at that cosine from outside travels down in a coat. Where a smooth interface reflects
/// everything, below an index of 1, light that a rough one transmits travels along it.
inline double cosine_in_coat(double cosine, double ior) {
  const double within = safe_sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  return ior < 1 ? std::max(within, 0.1) : within;
}

/// Fraction of light from `o` that single scattering at a rough interface transmits to the base below a medium.
inline double transmitted_fraction(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, double ior,
                                   double optical_thickness) {
  const UnshadowedFraction unshadowed(o, alpha);
  double sum = 0;
  normals.for_each(o, alpha, [&](const Vec3d& m, double weight_of_normal) {
    const double cosine = dot(o, m);
    double cos_t;
    const double passes = cosine > 0 ? 1 - fresnel_dielectric(cosine, ior, cos_t) : 0;
    if (passes == 0) return;
    const Vec3d i = m * (cosine / ior - cos_t) - o * (1 / ior);
    if (i.z < 0) sum += weight_of_normal * passes * std::exp(optical_thickness / i.z) * unshadowed(i);
  });
  return sum;
}

}  // namespace alhazen::impl
