#include "study/trial.h"

#include <fmt/format.h>

#include <algorithm>

namespace alhazen::study {

int64_t segments_of(const Settings& settings) { return settings.max_depth < 0 ? 0 : settings.max_depth + 1; }

std::string command_options(const Work& work) {
  const Settings& s = work.settings;
  std::string options;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) options += fmt::format("{}{} {}", options.empty() ? "" : " ", name, value);
  };
  if (work.objects > 0) options = fmt::format("[{} {}spheres]", work.objects, work.is_glass ? "glass " : "");
  if (work.queries == Queries::linear_scan) options += (options.empty() ? "" : " ") + std::string("[linear scan]");
  if (work.queries == Queries::binary_bvh) options += (options.empty() ? "" : " ") + std::string("[binary BVH]");
  add("--backend", s.backend);
  add("--strategy", s.strategy == "auto" ? "" : s.strategy);
  add("--schedule", s.schedule);
  add("--threads", s.threads > 0 ? std::to_string(s.threads) : "");
  add("--block", s.block);
  add("--chunk", s.chunk);
  add("--precision", s.precision);
  add("--integrator", s.integrator);
  add("--max-depth", s.max_depth >= 0 ? std::to_string(s.max_depth) : "");
  add("--size", s.width > 0 ? fmt::format("{}x{}", s.width, s.height) : "");
  add("--spp", s.samples_per_pixel > 0 ? std::to_string(s.samples_per_pixel) : "");
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

double processor_share(double processor_seconds, double seconds, const std::vector<double>& busy_seconds,
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
