#pragma once

// What a render did and what it cost.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/control.h"
#include "render/guiding.h"
#include "render/noise.h"
#include "render/settings.h"

namespace alhazen::impl {

/// How the images that a display shows were made of the radiance.
struct DisplayStatistics {
  double exposure = 0;               ///< stops
  bool exposure_is_metered = false;  ///< false also where the rule `fitting` found that it may stay 0
  double white_temperature = 0;      ///< kelvin; 0: no white balance
  bool white_is_estimated = false;
  std::string tone_map;
};

struct RenderStatistics {
  RenderSettings settings;
  std::string scene;
  SceneStatistics scene_sizes;
  double load_seconds = 0;         ///< reading, compiling and starting a GPU, without the BVH build
  double build_seconds = 0;        ///< BVH build
  double denoise_seconds = 0;      ///< 0 if no denoiser ran
  std::string denoiser;            ///< the one that denoised the image; empty: none
  double render_seconds = 0;       ///< taking samples, and deciding which pixels are finished
  uint32_t samples_per_pixel = 0;  ///< in complete passes
  double mean_samples = 0;         ///< of all pixels, also in a pass that was stopped
  NoiseState noise;                ///< zero without a noise target
  GuidingState guiding;            ///< zero without guiding
  bool complete = false;
  bool interrupted = false;  ///< stopped by the caller, not by a time limit
  uint64_t camera_samples = 0, rays = 0, shadow_rays = 0, nonfinite_samples = 0;
  uint64_t peak_rss_bytes = 0;               ///< peak of the process
  std::optional<DisplayStatistics> display;  ///< absent if no PNG or JPEG is written
  SampleCounters counters;                   ///< of all threads; zero in builds that do not count
  std::vector<ThreadStatistics> threads;

  double mean_segments() const;
  double msamples_per_second() const;
  double mrays_per_second() const;  ///< closest-hit and shadow rays
  std::string to_json() const;      ///< one object
};

uint64_t peak_rss_bytes();

}  // namespace alhazen::impl
