#pragma once

// The planes of a film on any device, and how a block of samples is added to them.

#include "core/film/block_sum.h"
#include "core/film/coverage.h"

namespace ALHAZEN_CORE {

/// Lists every plane of the film once: PLANE(element type, name). All but the first three exist only on
/// request:
/// `weights` if the filter has negative weights, those that start with `odd_` for denoising (`odd_weights` only beside
/// `weights`), those from `block_m2` to `finished` for a noise target, the others for their layers. `points` counts the
/// first points, whose sums are `position`, `displacement` and `uv`.
///
/// Planes that start with `odd_` are sums over every second block, the second, fourth, ... of a pixel, so that it has
/// two means that are independent of each other. `block_m2` is the sum of squared deviations of the luminance of blocks
/// from the pixel's mean, times their samples; `half_difference` the luminance of its first 2^k blocks less that of the
/// others, for the largest k that leaves some; `finished` is 1 where no more samples are taken.
///
/// With guiding, samples are taken in iterations that count differently. `radiance`, `weights`, their odd halves and
/// all that is said about variance are then of the last iteration. Those that start with `earlier_` are of the ones
/// before: sums times the weights of iterations, sums of filter weights times them, numbers of samples, the variance of
/// samples of the last of them, and with a noise target that of the mean of them all, by blocks and by halves
/// (render/noise.h).
#define ALHAZEN_FILM_PLANES(PLANE)            \
  PLANE(Vec3<Real>, radiance)                 \
  PLANE(uint32_t, samples)                    \
  PLANE(Real, alpha)                          \
  PLANE(Real, weights)                        \
  PLANE(Vec3<Real>, albedo)                   \
  PLANE(Vec3<Real>, normal)                   \
  PLANE(Real, depth)                          \
  PLANE(uint32_t, hits)                       \
  PLANE(uint32_t, segments)                   \
  PLANE(Vec3<Real>, position)                 \
  PLANE(Vec3<Real>, displacement)             \
  PLANE(Vec2<Real>, uv)                       \
  PLANE(uint32_t, points)                     \
  PLANE(Coverage<Real>, objects)              \
  PLANE(Coverage<Real>, materials)            \
  PLANE(LightPartSums<Real>, light)           \
  PLANE(LightGroupSums<Real>, groups)         \
  PLANE(Real, luminance_m2)                   \
  PLANE(Real, luminance_mean)                 \
  PLANE(Vec3<Real>, odd_radiance)             \
  PLANE(Vec3<Real>, odd_albedo)               \
  PLANE(Vec3<Real>, odd_normal)               \
  PLANE(Real, odd_depth)                      \
  PLANE(Real, odd_weights)                    \
  PLANE(Real, block_m2)                       \
  PLANE(Real, half_difference)                \
  PLANE(uint8_t, finished)                    \
  PLANE(Vec3<Real>, earlier_radiance)         \
  PLANE(Vec3<Real>, earlier_odd_radiance)     \
  PLANE(Real, earlier_alpha)                  \
  PLANE(LightPartSums<Real>, earlier_light)   \
  PLANE(LightGroupSums<Real>, earlier_groups) \
  PLANE(Real, earlier_weights)                \
  PLANE(Real, earlier_odd_weights)            \
  PLANE(uint32_t, earlier_samples)            \
  PLANE(Real, earlier_sample_variance)        \
  PLANE(Real, earlier_variance)               \
  PLANE(Real, earlier_half_variance)

/// Returns how many of the first `samples` samples of a pixel are in its second, fourth, ... block.
ALHAZEN_HD constexpr uint32_t samples_in_odd_blocks(uint32_t samples) {
  const uint32_t pairs = samples / (2 * samples_per_block), rest = samples % (2 * samples_per_block);
  return pairs * samples_per_block + (rest > samples_per_block ? rest - samples_per_block : 0);
}

/// Merges the moments of two sets of samples (Chan, Golub, LeVeque 1983).
template <class Real>
ALHAZEN_HD void merge_moments(Real& mean, Real& m2, uint32_t count, Real other_mean, Real other_m2,
                              uint32_t other_count) {
  const Real n = static_cast<Real>(count), m = static_cast<Real>(other_count);
  const Real delta = other_mean - mean;
  mean += delta * m / (n + m);
  m2 += other_m2 + delta * delta * n * m / (n + m);
}

/// Planes that were not requested are null. Elements are the pixels of the window, row by row.
template <class Real>
struct FilmView {
#define ALHAZEN_PLANE(type, name) type* name = nullptr;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  Real iteration_weight = 1;  ///< how much samples of the last iteration count, where there are iterations

  /// Returns whether anything about the first hit of camera rays is recorded besides radiance.
  ALHAZEN_HD WantedRecords wanted_records() const {
    return {albedo || normal || depth, points || objects || materials};
  }

  /// Whether light is divided into parts, which paths then keep (PartedLight).
  ALHAZEN_HD bool parts_light() const { return light || groups; }
  /// Whether blocks need the sums of layers.
  ALHAZEN_HD bool needs_layer_sums() const { return parts_light() || wanted_records().first_point; }

  ALHAZEN_HD bool is_finished(size_t i) const { return finished && finished[i]; }

  /// The number of samples of the last iteration, or of all where there are no iterations.
  ALHAZEN_HD uint32_t current_samples(size_t i) const {
    return samples[i] - (earlier_samples ? earlier_samples[i] : 0);
  }

  /// The variance of the luminance of one sample, unbiased; 0 where there is only one.
  ALHAZEN_HD Real sample_variance(size_t i) const {
    const uint32_t n = current_samples(i);
    if (n > 1) return luminance_m2[i] / static_cast<Real>(n - 1);
    return earlier_sample_variance ? earlier_sample_variance[i] : Real(0);
  }

  /// A sum of radiance over samples, and of their weights.
  struct RadianceSum {
    Vec3<Real> radiance;
    Real weight;

    ALHAZEN_HD Vec3<Real> mean() const { return weight != 0 ? radiance / weight : Vec3<Real>{}; }
  };

  /// Over all samples.
  ALHAZEN_HD RadianceSum radiance_sum(size_t i) const {
    const Real weight = weights ? weights[i] : static_cast<Real>(samples[i]);
    if (!earlier_weights) return {radiance[i], weight};
    return {radiance[i] * iteration_weight + earlier_radiance[i], weight * iteration_weight + earlier_weights[i]};
  }

  /// The fraction of the pixel that is not transparent, counted as radiance is.
  ALHAZEN_HD Real coverage(size_t i) const {
    const Real weight = radiance_sum(i).weight;
    const Real sum = earlier_alpha ? alpha[i] * iteration_weight + earlier_alpha[i] : alpha[i];
    return weight != 0 ? sum / weight : Real(0);
  }

  /// A part of the light, as the mean of `radiance_sum` is all of it.
  ALHAZEN_HD Vec3<Real> part_of_light(size_t i, LightPart part) const {
    return part_of(light, earlier_light, i, static_cast<uint32_t>(part));
  }

  /// The light of a group.
  ALHAZEN_HD Vec3<Real> light_of_group(size_t i, uint32_t group) const {
    return part_of(groups, earlier_groups, i, group);
  }

  /// Over the samples of every second block.
  ALHAZEN_HD RadianceSum odd_radiance_sum(size_t i) const {
    const Real weight = odd_weights ? odd_weights[i] : static_cast<Real>(samples_in_odd_blocks(samples[i]));
    if (!earlier_odd_weights) return {odd_radiance[i], weight};
    return {odd_radiance[i] * iteration_weight + earlier_odd_radiance[i],
            weight * iteration_weight + earlier_odd_weights[i]};
  }

  /// Adds a block to pixel `i`. The blocks of a pixel must be added in the order of their samples.
  ALHAZEN_HD void add(size_t i, const BlockSum<Real>& block) const {
    if (block_m2) add_deviation(i, block);
    if (luminance_m2)
      merge_moments(luminance_mean[i], luminance_m2[i], current_samples(i), block.luminance_mean, block.luminance_m2,
                    block.samples);
    if (odd_radiance && samples[i] / samples_per_block % 2 == 1) {
      odd_radiance[i] += block.radiance;
      odd_albedo[i] += block.albedo;
      odd_normal[i] += block.normal;
      odd_depth[i] += block.depth;
      if (odd_weights) odd_weights[i] += block.weight;
    }
    radiance[i] += block.radiance;
    samples[i] += block.samples;
    if (weights) weights[i] += block.weight;
    if (albedo) albedo[i] += block.albedo;
    if (normal) normal[i] += block.normal;
    if (depth) {
      depth[i] += block.depth;
      hits[i] += block.hits;
    }
    if (segments) segments[i] += block.segments;
    alpha[i] += block.alpha;
    if (light) light[i].add(block.layers.light);
    if (groups) groups[i].add(block.layers.groups);
    if (points || objects || materials) add_points(i, block);
  }

 private:
  template <class Sums>
  ALHAZEN_HD Vec3<Real> part_of(const Sums* sums, const Sums* earlier, size_t i, uint32_t k) const {
    const Real weight = radiance_sum(i).weight;
    const Vec3<Real> sum =
        earlier ? sums[i].radiance[k] * iteration_weight + earlier[i].radiance[k] : sums[i].radiance[k];
    return weight != 0 ? sum / weight : Vec3<Real>{};
  }

  ALHAZEN_HD ALHAZEN_COLD void add_points(size_t i, const BlockSum<Real>& block) const {
    const LayerSums<Real>& layers = block.layers;
    if (points) {
      points[i] += layers.points;
      position[i] += layers.position;
    }
    if (displacement) displacement[i] += layers.displacement;
    if (uv) uv[i] = {uv[i].x + layers.uv.x, uv[i].y + layers.uv.y};
    for (uint32_t s = 0; s < block.samples; ++s) {
      if (objects) objects[i].add(layers.object_ids[s], block.sample_weight[s]);
      if (materials) materials[i].add(layers.material_ids[s], block.sample_weight[s]);
    }
  }

  ALHAZEN_HD void add_deviation(size_t i, const BlockSum<Real>& block) const {
    const Real n = static_cast<Real>(current_samples(i)), m = static_cast<Real>(block.samples);
    const Real delta = block.luminance_mean - luminance_mean[i];
    block_m2[i] += delta * delta * n * m / (n + m);
    const uint32_t number = current_samples(i) / samples_per_block;
    if ((number & (number - 1)) == 0) half_difference[i] = luminance_mean[i] * n;
    half_difference[i] -= block.luminance_mean * m;
  }
};

}  // namespace ALHAZEN_CORE
