#include "study/trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/setting_table.h"

namespace alhazen::study {

int64_t segments_of(const Settings& settings) { return settings.max_depth < 0 ? 0 : settings.max_depth + 1; }

std::string command_options(const Work& work) {
  std::string options;
  if (work.objects > 0) options = fmt::format("[{} {}spheres]", work.objects, work.is_glass ? "glass " : "");
  if (work.queries == Queries::linear_scan) options += (options.empty() ? "" : " ") + std::string("[linear scan]");
  if (work.queries == Queries::binary_bvh) options += (options.empty() ? "" : " ") + std::string("[binary BVH]");
  for (const char* name : {"backend", "strategy", "schedule", "threads", "block", "chunk", "precision", "integrator",
                           "max-depth", "size", "spp"}) {
    const std::string value = setting_text(work.settings, name);
    if (value.empty() || (std::string(name) == "strategy" && value == "auto")) continue;
    options += fmt::format("{}--{} {}", options.empty() ? "" : " ", name, value);
  }
  return options;
}

std::string to_string(TrialStatus status) {
  switch (status) {
    case TrialStatus::not_run:
      return "not run";
    case TrialStatus::ok:
      return "ok";
    case TrialStatus::unavailable:
      return "unavailable";
    case TrialStatus::failed:
      break;
  }
  return "failed";
}

double processor_fraction(double processor_seconds, double seconds, const std::vector<double>& busy_seconds,
                          int processors) {
  double busy = 0;
  for (const double thread : busy_seconds) busy += thread;
  const double possible = std::min(busy, seconds * processors);
  return possible > 0 ? processor_seconds / possible : 1;
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

}  // namespace alhazen::study
