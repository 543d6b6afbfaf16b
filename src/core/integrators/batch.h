#pragma once

// Traces many paths at a time on one core. The rays of all active paths are traced together, so that the intersector
// can interleave their traversals; camera rays, which are coherent, are traced as packets. Random numbers are
// generated for all paths at once; then each path is shaded. A new sample takes the slot of a path that has ended.
// Each path does what `integrate` does, in the same order and with the same bits.

#include "core/bvh/ray_intersector.h"
#include "core/integrators/camera_rays.h"
#include "core/integrators/diffuse_surfaces.h"
#include "core/integrators/hit_points.h"

namespace ALHAZEN_CORE {

/// Receives sample i: its record, before the scene's exposure is applied, and its filter weight.
template <class End, class Real>
concept SampleReceiver = std::invocable < const End&,
        uint32_t, const SampleRecord<Real>
&, Real > ;

/// The paths of integrate_batch that are active.
template <IntegratorKind kind, class Sampler, class Real, BatchIntersector<Real> Intersector, PixelLookup Pixel,
          SampleReceiver<Real> End>
requires SamplerOf<Sampler, Real>
class PathBatch {
 public:
  PathBatch(const SceneView<Real>& scene, const Intersector& intersector, SampleSeed seed, uint32_t max_segments,
            const WantedRecords& wanted, PartedLight<Real>* parts, uint32_t count, const Pixel& pixel, const End& end)
      : scene_(scene),
        intersector_(intersector),
        seed_(seed),
        max_segments_(max_segments),
        wanted_(wanted),
        parts_(parts),
        count_(count),
        pixel_(pixel),
        end_(end) {}

  void run() {
    for (uint32_t i = 0; i < max_paths; ++i) ended_[i] = i;
    ended_count_ = max_paths;
    start();
    while (live_ > 0) {
      trace();
      end_escaped();
      generate_random_numbers();
      shade_all();
      trace_shadow_rays();
      finish();
      start();
    }
  }

  /// Number of active paths, chosen so that their state fits the second-level cache. It is not a power of two: accesses
  /// that alternate between columns a power of two apart are slow, since processors compare the low address bits first.
  static constexpr uint32_t max_paths = 176;

 private:
  static constexpr bool is_guided = kind == IntegratorKind::guided_path;

  /// An active path. It has cache lines of its own.
  struct alignas(64) Lane {
    Sampler sampler;
    StateOf<kind, Real> path;
    SampleRecord<Real> record;
    Hit<Real> hit;
    bool has_hit;
    uint32_t sample;  ///< index in the batch
    Real filter_weight;
  };

  /// A shadow ray whose result a path waits for.
  struct PendingShadowRay {
    ShadowRay<Real> shadow;
    Vec3<Real> radiance;  ///< added to the path as far as the light is visible
    uint32_t lane;
    uint32_t vertex;  ///< number of the vertex it starts at
  };

  /// Starts new samples in the slots of ended paths. They follow the continuing paths in `active_`.
  void start() {
    continuing_ = live_;
    const uint32_t count = ended_count_ < count_ - next_ ? ended_count_ : count_ - next_;
    camera_.make(scene_, seed_, count, [&](uint32_t i) { return pixel_(next_ + i); });
    for (uint32_t i = 0; i < count; ++i) {
      Lane& lane = lanes_[ended_[i]];
      lane.sampler = camera_.sampler(i);
      lane.sample = next_ + i;
      lane.filter_weight = camera_.filter_weight(i);
      lane.path = {};
      lane.path.ray = camera_.ray(scene_, i);
      lane.record.begin(wanted_);
      lane.record.parts = parts_ ? parts_ + lane.sample : nullptr;
      if constexpr (is_guided) trails_[ended_[i]].begin();
      active_[live_++] = ended_[i];
    }
    next_ += count;
    ended_count_ = 0;
  }

  void trace() {
    const auto ray = [&](uint32_t i) -> const Ray<Real>& { return lanes_[active_[i]].path.ray; };
    const auto limit = [](uint32_t) { return infinity<Real>; };
    const auto answer = [&](uint32_t i, bool found, const Hit<Real>& hit) {
      Lane& lane = lanes_[active_[i]];
      lane.hit = hit;
      lane.has_hit = found;
      if (found) prefetch_primitive(scene_, hit.primitive);
    };
    intersector_.template trace<false>(continuing_, ray, limit, answer);
    const uint32_t first = continuing_;
    intersector_.trace_coherent(
        live_ - first, [&](uint32_t i) -> const Ray<Real>& { return ray(first + i); }, limit,
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); });
  }

  /// Ends the paths that escaped and compacts the others in their order.
  void end_escaped() {
    uint32_t hits = 0, still_continuing = 0;
    for (uint32_t i = 0; i < live_; ++i) {
      const uint32_t index = active_[i];
      Lane& lane = lanes_[index];
      ++lane.record.segments;
      if constexpr (is_guided) trails_[index].start_segment(luminance(lane.record.radiance));
      if (lane.has_hit) {
        numbers_.samplers[hits] = lane.sampler;
        numbers_.first_dimension[hits] = VertexDimensions(lane.path.vertex).base;
        active_[hits++] = index;
        if (i < continuing_) still_continuing = hits;
      } else {
        add_infinite_lights(scene_, lane.path, lane.record);
        ended_[ended_count_++] = index;
      }
    }
    continuing_ = still_continuing;
    live_ = hits;
  }

  /// Generates the random numbers that shading may use.
  void generate_random_numbers() {
    constexpr VertexDimensions d = VertexDimensions::from(0);
    numbers_.draw(live_, 1u << d.bsdf_direction() | (scene_.has_lobes ? 1u << d.bsdf_lobe() : 0));
    if (!samples_lights(kind)) return;
    if (scene_.lights_count > 0) numbers_.draw(live_, 1u << d.light());
    numbers_.draw(continuing_, 1u << d.roulette());  // no path uses it at its first surface
  }

  /// Computes the hit points of paths that hit triangles.
  void compute_hit_points() {
    constexpr uint32_t ahead = 8;
    const auto prefetch = [&](uint32_t i) { prefetch_vertices(scene_, lanes_[active_[i]].hit.primitive); };
    for (uint32_t i = 0; i < ahead && i < live_; ++i) prefetch(i);
    for (uint32_t i = 0; i < live_; ++i) {
      if (i + ahead < live_) prefetch(i + ahead);
      const Lane& lane = lanes_[active_[i]];
      if (hit_points_.accepts(lane.hit)) hit_points_.add_triangle(i, scene_, lane.path.ray, lane.hit);
    }
    hit_points_.compute(live_);
    if constexpr (is_guided) find_regions();
  }

  /// Finds the regions of the points that are computed. Lookups of several paths wait for memory at the same time.
  void find_regions() {
    for (uint32_t i = 0; i < live_; ++i)
      if (hit_points_.accepts(lanes_[active_[i]].hit)) regions_[i] = region_at(scene_, hit_points_.position(i));
    for (uint32_t i = 0; i < live_; ++i)
      if (hit_points_.accepts(lanes_[active_[i]].hit))
        __builtin_prefetch(scene_.guide.quads + scene_.guide.regions[regions_[i]].quad);
  }

  void shade_all() {
    compute_hit_points();
    shadow_ray_count_ = 0;
    const uint32_t count = live_;
    live_ = 0;
    for (uint32_t i = 0; i < count; ++i) shade_one(numbers_.of(i), i, active_[i]);
    if constexpr (kind == IntegratorKind::path) shade_diffuse(count);
  }

  ALHAZEN_INLINE void continue_or_end(bool goes_on, uint32_t index) {
    if (goes_on)
      active_[live_++] = index;
    else
      ended_[ended_count_++] = index;
  }

  ALHAZEN_INLINE void add_shadow_ray(uint32_t index, const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
    PendingShadowRay& pending = shadow_rays_[shadow_ray_count_++];
    pending.shadow = shadow;
    pending.radiance = radiance;
    pending.lane = index;
    pending.vertex = lanes_[index].path.vertex;
  }

  /// `place` is the index in `active_`.
  template <SamplerOf<Real> Numbers>
  ALHAZEN_INLINE void shade_one(const Numbers& numbers, uint32_t place, uint32_t index) {
    Lane& lane = lanes_[index];
    if (scene_.has_cutouts && passes(scene_, lane.hit, ray_kind(lane.path.vertex), lane.path.ray, lane.path.travelled))
      return continue_or_end(lane.record.segments < max_transparent_hits, index);
    const bool is_computed = hit_points_.accepts(lane.hit);
    const ShadingPoint<Real> point = is_computed ? hit_points_.shading_point(place, scene_, lane.path.ray, lane.hit)
                                                 : shading_point(scene_, lane.path.ray, lane.hit);
    if constexpr (!samples_lights(kind)) {
      continue_or_end(shade_at(scene_, numbers, max_segments_, lane.hit, point, lane.path, lane.record), index);
    } else if (!handle_hit(scene_, max_segments_, lane.hit, point, lane.path, lane.record)) {
      continue_or_end(false, index);
    } else if (!is_guided && point.bsdf.kind == MaterialKind::diffuse) {
      if (!is_computed || point.material->features & MaterialFeatures::tangents) hit_points_.set(place, point);
      diffuse_.add(place, scene_, point, numbers, lane.path);
      diffuse_lanes_[place] = index;
    } else {
      const auto light = [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
        add_shadow_ray(index, shadow, radiance);
      };
      if constexpr (is_guided)
        if (is_computed && !point.bsdf.is_specular())
          return continue_or_end(
              light_and_scatter(scene_, numbers, point, lane.path, lane.record, light, trails_[index], regions_[place]),
              index);
      continue_or_end(light_and_scatter(scene_, numbers, point, lane.path, lane.record, light, trail_of(index)), index);
    }
  }

  /// Shades the diffuse hits that were set aside among the first `end` entries.
  void shade_diffuse(uint32_t end) {
    if (diffuse_.count() == 0) return;
    diffuse_.shade(hit_points_, numbers_, end);
    for (uint32_t i = 0; i < diffuse_.count(); ++i) {
      const uint32_t place = diffuse_.place(i), index = diffuse_lanes_[place];
      Lane& lane = lanes_[index];
      const DirectLight<Real> direct = diffuse_.direct(place, lane.hit, lane.path.ray.time);
      if (lane.record.parts) part_diffuse(lane, diffuse_.light(place));
      if (direct.is_lit) {
        ++lane.record.shadow_rays;
        add_shadow_ray(index, direct.shadow, direct.radiance);
      }
      diffuse_.take_over(place, lane.hit, lane.path);
      continue_or_end(diffuse_.goes_on(place), index);
    }
    diffuse_.clear();
  }

  /// Does what part_sampled_light and part_path do, at a diffuse surface.
  ALHAZEN_NOINLINE void part_diffuse(Lane& lane, uint32_t light) const {
    PartedLight<Real>& parts = *lane.record.parts;
    parts.sampled_group = light_group(scene_, light);
    parts.is_at_first = lane.path.vertex == 0;
    if (parts.is_at_first) parts.sampled = parts.path = {splat(Real(1)), false};
  }

  TrailOf<kind, Real>& trail_of(uint32_t index) { return trails_[is_guided ? index : 0]; }

  const Ray<Real>& shadow_ray(uint32_t i) const { return shadow_rays_[i].shadow.ray; }
  Real shadow_limit(uint32_t i) const { return shadow_rays_[i].shadow.t_max; }

  /// Not done where they are made, since that is the hottest code of all.
  void limit_shadow_rays() {
    for (uint32_t i = 0; i < shadow_ray_count_; ++i)
      shadow_rays_[i].radiance = limited(scene_, shadow_rays_[i].radiance, shadow_rays_[i].vertex >= 1);
  }

  void trace_shadow_rays() {
    if (scene_.indirect_limit > 0) limit_shadow_rays();
    if (scene_.lets_light_through) return trace_shadow_rays_through();
    intersector_.template trace<true>(
        shadow_ray_count_, [&](uint32_t i) -> const Ray<Real>& { return shadow_ray(i); },
        [&](uint32_t i) { return shadow_limit(i); },
        [&](uint32_t i, bool found, const Hit<Real>&) {
          if (!found) lanes_[shadow_rays_[i].lane].record.add_sampled(shadow_rays_[i].radiance);
        });
  }

  /// Does what `transmittance` does: traces the rays up to the next surface until each has arrived or is stopped.
  void trace_shadow_rays_through() {
    Real transmitted[max_paths];
    for (uint32_t i = 0; i < shadow_ray_count_; ++i) transmitted[i] = 1;
    for (uint32_t passed = 0; shadow_ray_count_ > 0; ++passed) {
      const auto answer = [&](uint32_t i, bool found, const Hit<Real>& hit) {
        Lane& lane = lanes_[shadow_rays_[i].lane];
        lane.hit = hit;
        lane.has_hit = found;
      };
      intersector_.template trace<false>(
          shadow_ray_count_, [&](uint32_t i) -> const Ray<Real>& { return shadow_ray(i); },
          [&](uint32_t i) { return shadow_limit(i); }, answer);
      uint32_t left = 0;
      for (uint32_t i = 0; i < shadow_ray_count_; ++i) {
        PendingShadowRay& pending = shadow_rays_[i];
        Lane& lane = lanes_[pending.lane];
        Real& fraction = transmitted[i];
        if (lane.has_hit && passed == max_transparent_hits) continue;
        if (lane.has_hit) pass_light(scene_, lane.hit, pending.shadow.ray, pending.shadow.t_max, fraction);
        if (!(fraction > 0)) continue;
        if (lane.has_hit && pending.shadow.t_max > 0) {
          transmitted[left] = fraction;
          shadow_rays_[left++] = pending;
        } else {
          lane.record.add_sampled(pending.radiance * fraction);
        }
      }
      shadow_ray_count_ = left;
    }
  }

  void finish() {
    for (uint32_t i = 0; i < ended_count_; ++i) {
      const Lane& lane = lanes_[ended_[i]];
      if constexpr (is_guided) learn_from_path(scene_, trails_[ended_[i]], lane.record.radiance);
      end_(lane.sample, lane.record, lane.filter_weight);
    }
  }

  const SceneView<Real>& scene_;
  const Intersector& intersector_;
  SampleSeed seed_;
  uint32_t max_segments_;
  WantedRecords wanted_;
  PartedLight<Real>* parts_;  ///< one per sample, or null
  uint32_t count_, next_ = 0;
  const Pixel& pixel_;
  const End& end_;
  Lane lanes_[max_paths];
  CameraRays<Real, Sampler, max_paths> camera_;                      ///< of the samples that start
  SampleBatch<Real, Sampler, max_paths, VertexDimensions> numbers_;  ///< in the order of `active_`
  uint32_t active_[max_paths], live_ = 0, continuing_ = 0;  ///< lanes; those from `continuing_` on trace camera rays
  PendingShadowRay shadow_rays_[max_paths];
  uint32_t shadow_ray_count_ = 0;
  uint32_t ended_[max_paths], ended_count_ = 0;
  HitPoints<Real, max_paths> hit_points_;
  DiffuseSurfaces<Real, max_paths> diffuse_;
  uint32_t diffuse_lanes_[max_paths];
  TrailOf<kind, Real> trails_[is_guided ? max_paths : 1];  ///< of the lanes
  uint32_t regions_[is_guided ? max_paths : 1];            ///< of the guide, in the order of `active_`
};

/// Takes `count` samples. `end` is called once for each, in any order. `parts` has an element for each, or is null.
template <IntegratorKind kind, class Sampler, class Real, BatchIntersector<Real> Intersector, PixelLookup Pixel,
          SampleReceiver<Real> End>
requires SamplerOf<Sampler, Real>
void integrate_batch(const SceneView<Real>& scene, const Intersector& intersector, SampleSeed seed,
                     uint32_t max_segments, const WantedRecords& wanted, PartedLight<Real>* parts, uint32_t count,
                     const Pixel& pixel, const End& end) {
  PathBatch<kind, Sampler, Real, Intersector, Pixel, End> batch(scene, intersector, seed, max_segments, wanted, parts,
                                                                count, pixel, end);
  batch.run();
}

}  // namespace ALHAZEN_CORE
