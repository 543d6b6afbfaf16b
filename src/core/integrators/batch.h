#pragma once

// Many paths at a time on one core: the rays of all that are under way are traced together, so that the intersector can
// walk them in turns, and so are the camera rays of those that begin, which go much the same way; random numbers are
// drawn for all at once; then each path is shaded. A path that ends makes room for the next sample. What a path does is
// what `integrate` does, in the same order, to the same bits.

#include "core/integrators/camera_sample.h"
#include "core/sampling/drawn_numbers.h"

namespace ALHAZEN_CORE {

/// Sample number `sample` of pixel (x, y).
struct PixelSample {
  uint32_t x, y, sample;
};

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
      numbers_.draw(live_);
      shade_all();
      look_for_light();
      finish();
      start();
    }
  }

  /// How many paths are under way. Their state stays in the second level cache.
  static constexpr uint32_t most_paths = 128;

 private:
  /// A path under way, and the light that it waits for.
  struct Lane {
    Sampler sampler;
    StateOf<kind, Real> path;
    SampleRecord<Real> record;
    Hit<Real> hit;
    bool has_met;
    uint32_t sample;  ///< which of the batch
    Real filter_weight;
    ShadowRay<Real> shadow;
    Vec3<Real> lit;  ///< what the path gains where the shadow ray is free
  };

  /// Lets samples begin where paths have ended. Those that begin stand behind those that go on.
  void start() {
    going_on_ = live_;
    const uint32_t count = ended_count_ < count_ - next_ ? ended_count_ : count_ - next_;
    for (uint32_t i = 0; i < count; ++i) pixels_[i] = pixel_(next_ + i);
    for (uint32_t i = 0; i < count; ++i)
      camera_numbers_.samplers[i] = Sampler(seed_, pixels_[i].x, pixels_[i].y, pixels_[i].sample);
    for (uint32_t i = 0; i < count; ++i) camera_numbers_.first_dimension[i] = 0;
    camera_numbers_.draw(count);
    for (uint32_t i = 0; i < count; ++i) {
      Lane& lane = lanes_[ended_[i]];
      const CameraSample<Real> camera = sample_camera(scene_, camera_numbers_.of(i), pixels_[i].x, pixels_[i].y);
      lane.sampler = camera_numbers_.samplers[i];
      lane.sample = next_ + i;
      lane.filter_weight = camera.filter_weight;
      lane.path = {};
      lane.path.ray = camera.ray;
      lane.record = {};
      lane.record.keeps_first_hit = wants_first_hit_;
      wait(lane, ended_[i]);
    }
    next_ += count;
    ended_count_ = 0;
  }

  /// The path of this lane is to take its next segment.
  ALHAZEN_INLINE void wait(const Lane& lane, uint32_t index) {
    numbers_.samplers[live_] = lane.sampler;
    numbers_.first_dimension[live_] = VertexDimensions(lane.path.vertex).base;
    active_[live_++] = index;
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

  void shade_all() {
    constexpr uint32_t ahead = 8;
    const auto prefetch = [&](uint32_t i) {
      const Lane& lane = lanes_[active_[i]];
      if (lane.has_met) prefetch_vertices(scene_, lane.hit.primitive);
    };
    for (uint32_t i = 0; i < ahead && i < live_; ++i) prefetch(i);
    lit_count_ = 0;
    const uint32_t count = live_;
    live_ = 0;
    for (uint32_t i = 0; i < count; ++i) {
      if (i + ahead < count) prefetch(i + ahead);
      const uint32_t index = active_[i];
      Lane& lane = lanes_[index];
      ++lane.record.segments;
      bool goes_on = false;
      if (lane.has_met)
        goes_on = shade(scene_, numbers_.of(i), max_segments_, lane.hit, lane.path, lane.record,
                        [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
                          lane.shadow = shadow;
                          lane.lit = radiance;
                          lit_[lit_count_++] = index;
                        });
      else
        leave_scene(scene_, lane.path, lane.record);
      if (goes_on)
        wait(lane, index);
      else
        ended_[ended_count_++] = index;
    }
  }

  void look_for_light() {
    if (scene_.has_cutouts) {
      for (uint32_t i = 0; i < lit_count_; ++i) {
        Lane& lane = lanes_[lit_[i]];
        const Real share = free_share(scene_, intersector_, lane.shadow);
        if (share > 0) lane.record.radiance += lane.lit * share;
      }
      return;
    }
    intersector_.template trace<true>(
        lit_count_, [&](uint32_t i) -> const Ray<Real>& { return lanes_[lit_[i]].shadow.ray; },
        [&](uint32_t i) { return lanes_[lit_[i]].shadow.t_max; },
        [&](uint32_t i, bool found, const Hit<Real>&) {
          if (!found) lanes_[lit_[i]].record.radiance += lanes_[lit_[i]].lit;
        });
  }

  void finish() {
    for (uint32_t i = 0; i < ended_count_; ++i) {
      Lane& lane = lanes_[ended_[i]];
      lane.record.radiance *= scene_.exposure;
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
  PixelSample pixels_[most_paths];
  DrawnNumbers<Real, Sampler, most_paths, CameraDimensions::count> camera_numbers_;  ///< of those that begin
  DrawnNumbers<Real, Sampler, most_paths, VertexDimensions::count> numbers_;         ///< of all, as `active_` has them
  uint32_t active_[most_paths], live_ = 0, going_on_ = 0;  ///< lanes; the first `going_on_` of them are no camera rays
  uint32_t lit_[most_paths], lit_count_ = 0;
  uint32_t ended_[most_paths], ended_count_ = 0;
};

/// Takes `count` samples: `pixel(i)` says which sample i is, `end(i, record, filter_weight)` is called once for each,
/// in any order. Records keep the first hit where that is wanted.
template <IntegratorKind kind, class Sampler, class Real, class Intersector, class Pixel, class End>
void integrate_batch(const SceneView<Real>& scene, const Intersector& intersector, uint32_t seed, uint32_t max_segments,
                     bool wants_first_hit, uint32_t count, const Pixel& pixel, const End& end) {
  PathBatch<kind, Sampler, Real, Intersector, Pixel, End> batch(scene, intersector, seed, max_segments, wants_first_hit,
                                                                count, pixel, end);
  batch.run();
}

}  // namespace ALHAZEN_CORE
