#pragma once

// What a study measures: one way of rendering one scene, and what came out of every time that it was run.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"

namespace alhazen::study {

/// What answers ray queries: what the backend uses, or, by the serial backend and `iterative` alone, something slower.
enum class Queries { of_backend, linear_scan, binary_bvh };

struct Work {
  Settings settings;  ///< backend, strategy, ... as on the command line
  Queries queries = Queries::of_backend;
  uint64_t objects = 0;      ///< 0: the study's scene; else a cloud of so many spheres (objects_scene.h)
  bool is_glass = false;     ///< the cloud: dense and of glass
  bool is_compared = false;  ///< whether its picture is compared with a reference
};

/// The options of `alhazen render` that do this work, as far as there are any: also the name of the work.
std::string command_options(const Work& work);
/// D, which counts segments: 0 where the work leaves it to the scene.
int64_t segments_of(const Settings& settings);

enum class TrialStatus { not_run, ok, unavailable, failed };
std::string to_string(TrialStatus status);

/// Work and its measurements. All repeats take the same samples and rays.
struct Trial {
  std::string key;  ///< command_options(work)
  Work work;
  TrialStatus status = TrialStatus::not_run;
  std::string reason;                             ///< why there is nothing, in one line
  std::vector<double> seconds;                    ///< of the render phase, in the order in which they were measured
  std::vector<std::vector<double>> busy_seconds;  ///< the same, thread by thread
  std::vector<double> processor_shares;           ///< the same: processor_share of each
  std::vector<double> disturbed_seconds;          ///< of runs that were made again, since others took the processors
  double build_seconds = 0;                       ///< of the BVH, the last time
  int64_t width = 0, height = 0;
  uint64_t samples_per_pixel = 0;
  uint64_t samples = 0, rays = 0, shadow_rays = 0;
  double rmse = -1;  ///< of the picture against the reference; negative: not compared

  bool has_times() const { return status == TrialStatus::ok && !seconds.empty(); }
};

struct Spread {
  double median = 0, min = 0, max = 0;
};

/// How much of the processor time that its threads could have had a run was given: 1 where it had the machine to
/// itself.
double processor_share(double processor_seconds, double seconds, const std::vector<double>& busy_seconds,
                       int processors);
/// Runs that were given less are disturbed: something else ran.
inline constexpr double least_share = 0.9;

/// Of at least one value.
Spread spread_of(std::vector<double> values);

}  // namespace alhazen::study
