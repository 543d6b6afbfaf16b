#include "alhazen/rays.h"

#include <utility>

#include "alhazen/scene.h"
#include "api/arguments.h"
#include "api/building.h"
#include "api/scene_state.h"
#include "pipeline/load_scene.h"
#include "queries/query_scene.h"
#include "render/setting_table.h"
#include "util/thread_limit.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// Those that choose what is read.
Settings reading_settings(const Settings& settings) {
  Settings reading;
  reading.confine = settings.confine;
  reading.search_paths = settings.search_paths;
  reading.strict = settings.strict;
  reading.variant = settings.variant;
  reading.animation = settings.animation;
  reading.animation_time = settings.animation_time;
  reading.shutter = settings.shutter;
  reading.frames_per_second = settings.frames_per_second;
  reading.definitions = settings.definitions;
  return reading;
}

impl::Precision precision_of(const Settings& settings) {
  for (const impl::Precision precision : {impl::Precision::single, impl::Precision::double_})
    if (settings.precision == impl::to_string(precision)) return precision;
  throw impl::InputError("unknown precision '" + settings.precision + "': it may be float, double");
}

/// Builds the scene that `describe` returns.
template <class Describe>
std::shared_ptr<const impl::QueryScene> query_scene_of(const Describe& describe, const Settings& settings,
                                                       const ProgressFunction& progress) {
  const impl::ThreadDefaults defaults;
  const impl::Precision precision = precision_of(settings);
  impl::for_caller([&] { impl::check_setting(settings, "threads"); });
  impl::Diagnostics diagnostics;
  impl::Listener listener(progress);
  listener.watch(diagnostics.activity());
  return listener.for_caller([&] {
    return std::make_shared<const impl::QueryScene>(describe(diagnostics), precision, settings.threads, diagnostics);
  });
}

}  // namespace

RayQueries RayQueries::from_file(const std::string& scene_file, const Settings& settings,
                                 const ProgressFunction& progress) {
  const auto read = [&](impl::Diagnostics& diagnostics) {
    return impl::load_scene(scene_file, reading_settings(settings), diagnostics).scene;
  };
  return RayQueries(query_scene_of(read, settings, progress));
}

RayQueries::RayQueries(const Scene& scene, const Settings& settings, const ProgressFunction& progress)
    : scene_(query_scene_of([&](impl::Diagnostics&) { return scene.state().to_render(0); }, settings, progress)) {}

RayQueries::RayQueries(std::shared_ptr<const impl::QueryScene> scene) : scene_(std::move(scene)) {
  if (!scene_) impl::refuse_argument("scene", "must not be null");
}

void RayQueries::closest_hits(const RayArrays<float>& rays, const HitArrays<float>& hits, int threads) const {
  scene_->closest_hits(rays, hits, threads);
}
void RayQueries::closest_hits(const RayArrays<double>& rays, const HitArrays<double>& hits, int threads) const {
  scene_->closest_hits(rays, hits, threads);
}

void RayQueries::occluded(const RayArrays<float>& rays, uint8_t* occluded, int threads) const {
  scene_->occluded(rays, occluded, threads);
}
void RayQueries::occluded(const RayArrays<double>& rays, uint8_t* occluded, int threads) const {
  scene_->occluded(rays, occluded, threads);
}

const Box& RayQueries::bounds() const { return scene_->bounds(); }

const std::vector<Warning>& RayQueries::warnings() const { return scene_->warnings(); }

}  // namespace ALHAZEN_NAMESPACE
