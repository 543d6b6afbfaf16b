#include "study/trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/setting_table.h"

namespace alhazen::impl::study {

int64_t segments_of(const Settings& settings) { return settings.max_depth < 0 ? 0 : settings.max_depth + 1; }

std::string command_options(const Work& work) {
  std::string options;
  if (work.objects > 0) options = fmt::format("[{} {}spheres]", work.objects, work.is_glass ? "glass " : "");
  const char* const names[] = {"", "[a path at a time]", "[linear scan]", "[binary BVH]"};
  if (work.queries != Queries::of_backend)
    options += (options.empty() ? "" : " ") + std::string(names[static_cast<size_t>(work.queries)]);
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

void Trial::add_run(const Trial& other, size_t run) {
  seconds.push_back(other.seconds[run]);
  busy_seconds.push_back(other.busy_seconds[run]);
  processor_fractions.push_back(other.processor_fractions[run]);
  switches.push_back(other.switches[run]);
}

void Trial::erase_run(size_t run) {
  const auto at = static_cast<std::ptrdiff_t>(run);
  seconds.erase(seconds.begin() + at);
  busy_seconds.erase(busy_seconds.begin() + at);
  processor_fractions.erase(processor_fractions.begin() + at);
  switches.erase(switches.begin() + at);
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

}  // namespace alhazen::impl::study
