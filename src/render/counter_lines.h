#pragma once

// The counters of samples as lines of a table (core/integrators/sample_counters.h).

#include <string>
#include <vector>

#include "core/integrators/sample_counters.h"

namespace alhazen::impl {

/// Light samples of one kind of light, or at surfaces with one kind of closure.
struct LightSampleLine {
  std::string kind;
  LightSampleCounts counts;
};

struct BsdfSampleLine {
  std::string kind;
  BsdfSampleCounts counts;
};

/// The kinds of which something was drawn.
struct CounterLines {
  std::vector<LightSampleLine> by_light, by_closure;
  std::vector<BsdfSampleLine> bsdf;
};

CounterLines counter_lines(const SampleCounters& counters);

/// Three tables; the columns of what was not used are percentages.
std::string counter_table(const SampleCounters& counters);

}  // namespace alhazen::impl
