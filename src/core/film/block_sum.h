#pragma once

// Sums over a few samples of one pixel: the unit that every backend adds to the film.

#include "core/integrators/sample_record.h"
#include "core/math/scalar.h"

namespace ALHAZEN_CORE {

/// Samples are summed in blocks of this size, and blocks are added to the film in order.
inline constexpr uint32_t samples_per_block = 4;

/// What only some layers need of a block. It is three times as large as all else.
template <class Real>
struct LayerSums {
  LightPartSums<Real> light;
  LightGroupSums<Real> groups;
  Vec3<Real> position, displacement;
  Vec2<Real> uv;
  uint32_t points;
  uint32_t object_ids[samples_per_block], material_ids[samples_per_block];  ///< of each sample, or no_id
};

template <class Real>
struct BlockSum {
  Vec3<Real> radiance, albedo, normal;
  Real weight;  ///< of the pixel filter
  Real depth;
  Real alpha;                         ///< what of the weight is not transparent
  Real luminance_mean, luminance_m2;  ///< Welford's running mean and sum of squared deviations
  Real sample_weight[samples_per_block];
  uint32_t samples, hits, segments, shadow_rays, nonfinite;
  [[no_unique_address]] RecordCounters counters;
  LayerSums<Real> layers;  ///< begun where they are wanted

  /// Begins a block, with or without the sums of layers.
  ALHAZEN_HD void begin(bool with_layers) {
    radiance = albedo = normal = {};
    weight = depth = alpha = luminance_mean = luminance_m2 = 0;
    samples = hits = segments = shadow_rays = nonfinite = 0;
    counters = {};
    if (with_layers) layers = {};
  }

  ALHAZEN_HD void add_first_hit(const FirstHit<Real>& first) {
    ++hits;
    albedo += first.albedo;
    normal += first.normal;
    depth += first.depth;
  }

  /// Adds the first point of the sample that add_path adds next.
  ALHAZEN_HD void add_first_point(const FirstPoint<Real>& point) {
    ++layers.points;
    layers.position += point.position;
    layers.displacement += point.displacement;
    layers.uv = {layers.uv.x + point.uv.x, layers.uv.y + point.uv.y};
    layers.object_ids[samples] = point.object_id;
    layers.material_ids[samples] = point.material_id;
  }

  /// Adds one sample with its own `filter_weight`; infinite or NaN radiance counts as black.
  ALHAZEN_HD void add_path(const PathRecord<Real>& path, Real filter_weight) {
    segments += path.segments;
    shadow_rays += path.shadow_rays;
    sample_weight[samples] = filter_weight;
    ++samples;
    weight += filter_weight;
    alpha += filter_weight * (1 - path.transparency);
    Vec3<Real> value = path.radiance;
    if (!is_finite(value)) {
      ++nonfinite;
      value = {};
    } else if (path.parts) {
      layers.light.add(path.parts->sums, filter_weight);
      layers.groups.add(path.parts->groups, filter_weight);
    }
    radiance += value * filter_weight;
    const Real y = luminance(value);
    const Real delta = y - luminance_mean;
    luminance_mean += delta / static_cast<Real>(samples);
    luminance_m2 += delta * (y - luminance_mean);
  }

  ALHAZEN_HD void add(const SampleRecord<Real>& sample, Real filter_weight) {
    if (sample.has_hit) add_first_hit(sample.first);
    if (sample.has_point) add_first_point(sample.first_point);
    counters.add(sample.counters);
    add_path(sample, filter_weight);
  }
};

}  // namespace ALHAZEN_CORE
