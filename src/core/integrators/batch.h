#pragma once

// Many paths at a time on one core: the rays of all that are under way are traced together, so that the intersector can
// walk them in turns, and so are the camera rays of those that begin, which go much the same way; random numbers are
// drawn for all at once; then each path is shaded. A path that ends makes room for the next sample. What a path does is
// what `integrate` does, in the same order, to the same bits.

#include "core/integrators/camera_rays.h"
#include "core/integrators/diffuse_surfaces.h"
#include "core/integrators/met_surfaces.h"

namespace ALHAZEN_CORE {

/// `Pixel` and `End` are those of integrate_batch.
template <IntegratorKind kind, class Sampler, class Real, class Intersector, class Pixel, class End>
class PathBatch {
 public:
  PathBatch(const SceneView<Real>& scene, const Intersector& intersector, uint32_t seed, uint32_t max_segments,
            bool wants_first_hit, uint32_t count, const Pixel& pixel, const End& end)
      : scene_(scene),
        intersector_(intersector),
        seed_(seed),
        max_segments_(max_segments),
        wants_first_hit_(wants_first_hit),
        count_(count),
        pixel_(pixel),
        end_(end) {}

  void run() {
    for (uint32_t i = 0; i < most_paths; ++i) ended_[i] = i;
    ended_count_ = most_paths;
    start();
    while (live_ > 0) {
      trace();
      leave();
      draw_numbers();
      shade_all();
      look_for_light();
      finish();
      start();
    }
  }

  /// How many paths are under way. Their state stays in the second level cache. No power of two: columns that lie one
  /// apart are slow to write and read in turns, since processors compare the low bits of addresses first.
  static constexpr uint32_t most_paths = 176;

 private:
  /// A path under way, in cache lines of its own.
  struct alignas(64) Lane {
    Sampler sampler;
    StateOf<kind, Real> path;
    SampleRecord<Real> record;
    Hit<Real> hit;
    bool has_met;
    uint32_t sample;  ///< which of the batch
    Real filter_weight;
  };

  /// The way to a light that a path waits for.
  struct WayToLight {
    ShadowRay<Real> shadow;
    Vec3<Real> radiance;  ///< what the path gains where the shadow ray is free
    uint32_t lane;
  };

  /// Lets samples begin where paths have ended. Those that begin stand behind those that go on.
  void start() {
    going_on_ = live_;
    const uint32_t count = ended_count_ < count_ - next_ ? ended_count_ : count_ - next_;
    camera_.make(scene_, seed_, count, [&](uint32_t i) { return pixel_(next_ + i); });
    for (uint32_t i = 0; i < count; ++i) {
      Lane& lane = lanes_[ended_[i]];
      lane.sampler = camera_.sampler(i);
      lane.sample = next_ + i;
      lane.filter_weight = camera_.filter_weight(i);
      lane.path = {};
      lane.path.ray.origin = camera_.origin(i);
      lane.path.ray.direction = camera_.direction(i);
      lane.path.ray.time = camera_.time(scene_, i);
      lane.record.begin(wants_first_hit_);
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
      lane.has_met = found;
      if (found) prefetch_primitive(scene_, hit.primitive);
    };
    intersector_.template trace<false>(going_on_, ray, limit, answer);
    const uint32_t first = going_on_;
    intersector_.trace_coherent(
        live_ - first, [&](uint32_t i) -> const Ray<Real>& { return ray(first + i); }, limit,
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); });
  }

  /// Ends the paths that have met nothing; the others stand together then, in their order.
  void leave() {
    uint32_t met = 0;
    const auto leave_or_keep = [&](uint32_t i) {
      const uint32_t index = active_[i];
      Lane& lane = lanes_[index];
      ++lane.record.segments;
      if (lane.has_met) {
        numbers_.samplers[met] = lane.sampler;
        numbers_.first_dimension[met] = VertexDimensions(lane.path.vertex).base;
        active_[met++] = index;
      } else {
        leave_scene(scene_, lane.path, lane.record);
        ended_[ended_count_++] = index;
      }
    };
    for (uint32_t i = 0; i < going_on_; ++i) leave_or_keep(i);
    const uint32_t still_going_on = met;
    for (uint32_t i = going_on_; i < live_; ++i) leave_or_keep(i);
    going_on_ = still_going_on;
    live_ = met;
  }

  /// Draws what surfaces may ask for.
  void draw_numbers() {
    constexpr VertexDimensions d = VertexDimensions::from(0);
    numbers_.draw(live_, 1u << d.bsdf_direction() | (scene_.has_lobes ? 1u << d.bsdf_lobe() : 0));
    if (kind != IntegratorKind::path) return;
    if (scene_.lights_count > 0) numbers_.draw(live_, 1u << d.light_point());
    if (scene_.lights_count > 1) numbers_.draw(live_, 1u << d.light_choice());
    numbers_.draw(going_on_, 1u << d.roulette());  // which no path meets at its first surface
  }

  /// Works out where the paths have met triangles.
  void meet_triangles() {
    constexpr uint32_t ahead = 8;
    const auto prefetch = [&](uint32_t i) { prefetch_vertices(scene_, lanes_[active_[i]].hit.primitive); };
    for (uint32_t i = 0; i < ahead && i < live_; ++i) prefetch(i);
    for (uint32_t i = 0; i < live_; ++i) {
      if (i + ahead < live_) prefetch(i + ahead);
      const Lane& lane = lanes_[active_[i]];
      if (met_.takes(lane.hit)) met_.meet(i, scene_, lane.path.ray, lane.hit);
    }
    met_.work_out(live_);
  }

  void shade_all() {
    meet_triangles();
    ways_count_ = 0;
    const uint32_t count = live_;
    live_ = 0;
    for (uint32_t i = 0; i < count; ++i) shade_one(numbers_.of(i), i, active_[i]);
    if constexpr (kind == IntegratorKind::path) shade_diffuse(count);
  }

  ALHAZEN_INLINE void go_on_or_end(bool goes_on, uint32_t index) {
    if (goes_on)
      active_[live_++] = index;
    else
      ended_[ended_count_++] = index;
  }

  ALHAZEN_INLINE void ask_for_light(uint32_t index, const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
    WayToLight& way = ways_[ways_count_++];
    way.shadow = shadow;
    way.radiance = radiance;
    way.lane = index;
  }

  /// `place` is that in `active_`.
  template <class Numbers>
  ALHAZEN_INLINE void shade_one(const Numbers& numbers, uint32_t place, uint32_t index) {
    Lane& lane = lanes_[index];
    if (scene_.has_cutouts && passes(scene_, lane.hit, ray_kind(lane.path.vertex), lane.path.ray, lane.path.travelled))
      return go_on_or_end(lane.record.segments < most_passages, index);
    const bool is_met = met_.takes(lane.hit);
    const ShadingPoint<Real> point = is_met ? met_.shading_point(place, scene_, lane.path.ray, lane.hit)
                                            : shading_point(scene_, lane.path.ray, lane.hit);
    if constexpr (kind != IntegratorKind::path) {
      go_on_or_end(shade_at(scene_, numbers, max_segments_, lane.hit, point, lane.path, lane.record), index);
    } else if (!arrive(scene_, max_segments_, lane.hit, point, lane.path, lane.record)) {
      go_on_or_end(false, index);
    } else if (point.bsdf.kind == MaterialKind::diffuse) {
      if (!is_met || point.material->features & MaterialFeatures::tangents) met_.set(place, point);
      diffuse_.add(place, scene_, point, numbers, lane.path);
      diffuse_lanes_[place] = index;
    } else {
      const auto light = [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
        ask_for_light(index, shadow, radiance);
      };
      go_on_or_end(light_and_scatter(scene_, numbers, point, lane.path, lane.record, light), index);
    }
  }

  /// The diffuse surfaces that have been put aside, among the first `end` places.
  void shade_diffuse(uint32_t end) {
    if (diffuse_.count() == 0) return;
    diffuse_.shade(met_, numbers_, end);
    for (uint32_t i = 0; i < diffuse_.count(); ++i) {
      const uint32_t place = diffuse_.place(i), index = diffuse_lanes_[place];
      Lane& lane = lanes_[index];
      if (diffuse_.is_lit(place)) {
        ++lane.record.shadow_rays;
        ask_for_light(index, diffuse_.shadow(place, lane.hit, lane.path.ray.time), diffuse_.lit(place));
      }
      diffuse_.take_over(place, lane.hit, lane.path);
      go_on_or_end(diffuse_.goes_on(place), index);
    }
    diffuse_.clear();
  }

  void look_for_light() {
    if (scene_.lets_light_through) {
      for (const WayToLight* way = ways_; way != ways_ + ways_count_; ++way) {
        const Real share = free_share(scene_, intersector_, way->shadow);
        if (share > 0) lanes_[way->lane].record.radiance += way->radiance * share;
      }
      return;
    }
    intersector_.template trace<true>(
        ways_count_, [&](uint32_t i) -> const Ray<Real>& { return ways_[i].shadow.ray; },
        [&](uint32_t i) { return ways_[i].shadow.t_max; },
        [&](uint32_t i, bool found, const Hit<Real>&) {
          if (!found) lanes_[ways_[i].lane].record.radiance += ways_[i].radiance;
        });
  }

  void finish() {
    for (uint32_t i = 0; i < ended_count_; ++i) {
      const Lane& lane = lanes_[ended_[i]];
      end_(lane.sample, lane.record, lane.filter_weight);
    }
  }

  const SceneView<Real>& scene_;
  const Intersector& intersector_;
  uint32_t seed_, max_segments_;
  bool wants_first_hit_;
  uint32_t count_, next_ = 0;
  const Pixel& pixel_;
  const End& end_;
  Lane lanes_[most_paths];
  CameraRays<Real, Sampler, most_paths> camera_;                       ///< of those that begin
  DrawnNumbers<Real, Sampler, most_paths, VertexDimensions> numbers_;  ///< of all, as `active_` has them
  uint32_t active_[most_paths], live_ = 0, going_on_ = 0;  ///< lanes; the first `going_on_` of them are no camera rays
  WayToLight ways_[most_paths];
  uint32_t ways_count_ = 0;
  uint32_t ended_[most_paths], ended_count_ = 0;
  MetSurfaces<Real, most_paths> met_;
  DiffuseSurfaces<Real, most_paths> diffuse_;
  uint32_t diffuse_lanes_[most_paths];
};

/// Takes `count` samples: `pixel(i)` says which sample i is, `end(i, record, filter_weight)` is called once for each,
/// in any order, before the scene's exposure. Records keep the first hit where that is wanted.
template <IntegratorKind kind, class Sampler, class Real, class Intersector, class Pixel, class End>
void integrate_batch(const SceneView<Real>& scene, const Intersector& intersector, uint32_t seed, uint32_t max_segments,
                     bool wants_first_hit, uint32_t count, const Pixel& pixel, const End& end) {
  PathBatch<kind, Sampler, Real, Intersector, Pixel, End> batch(scene, intersector, seed, max_segments, wants_first_hit,
                                                                count, pixel, end);
  batch.run();
}

}  // namespace ALHAZEN_CORE
