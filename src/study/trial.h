#pragma once

// What a study measures: a configuration for rendering a scene, and the results of its repeated runs.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"

namespace alhazen::impl::study {

/// How samples are taken: in batches of many paths, as backends on CPUs do, or with `iterative` alone by something
/// slower, a path at a time or with other ray queries (query_kernels.h).
enum class Queries { of_backend, path_at_a_time, linear_scan, binary_bvh };

struct Work {
  Settings settings;  ///< backend, strategy, ... as on the command line
  Queries queries = Queries::of_backend;
  uint64_t objects = 0;      ///< 0: the study's scene; else a cloud of this many spheres (objects_scene.h)
  bool is_glass = false;     ///< the cloud is dense and of glass
  bool is_compared = false;  ///< whether its image is compared with a reference
};

/// The options of `alhazen render` that do this work, as far as there are any; they also name the work.
std::string command_options(const Work& work);
/// D, which counts segments; 0 if the work leaves it to the scene.
int64_t segments_of(const Settings& settings);

enum class TrialStatus { not_run, ok, unavailable, failed };
std::string to_string(TrialStatus status);

/// A work and its measurements. All repeats take the same samples and rays.
struct Trial {
  std::string key;  ///< command_options(work)
  Work work;
  TrialStatus status = TrialStatus::not_run;
  std::string reason;                             ///< why there are no times, in one line
  std::vector<double> seconds;                    ///< of the render phase, in the order of measurement
  std::vector<std::vector<double>> busy_seconds;  ///< the same, per thread
  std::vector<double> processor_fractions;        ///< processor_fraction of each run
  std::vector<uint64_t> switches;                 ///< involuntary context switches during each run
  std::vector<double> disturbed_seconds;          ///< of runs that were replaced by others (disturbance.h)
  double build_seconds = 0;                       ///< of the BVH, in the last run
  int64_t width = 0, height = 0;
  uint64_t samples_per_pixel = 0;
  uint64_t samples = 0, rays = 0, shadow_rays = 0;
  double rmse = -1;      ///< of the image against the reference; negative: not compared
  bool is_asked = true;  ///< false: kept from an earlier run, and not measured now

  /// Whether fewer than `repeats` runs were measured, unless they cannot be.
  bool lacks_runs(int repeats) const {
    return (status == TrialStatus::not_run || status == TrialStatus::ok) &&
           seconds.size() < static_cast<size_t>(repeats);
  }
  bool has_times() const { return status == TrialStatus::ok && !seconds.empty(); }

  void add_run(const Trial& other, size_t run);
  void erase_run(size_t run);
};

struct Spread {
  double median = 0, min = 0, max = 0;
};

/// The spread of at least one value.
Spread spread_of(std::vector<double> values);

}  // namespace alhazen::impl::study
