#pragma once

// Measures the trials of a study in rounds: each round runs every trial once, in a different order, so that changes on
// the machine affect all of them alike.

#include <functional>

#include "study/run_work.h"
#include "study/study.h"

namespace alhazen::impl::study {

struct Measuring {
  int round = 1, rounds = 1;
  size_t done = 0, total = 0;  ///< runs over all rounds, without those that are impossible
  std::string cell;            ///< the first one that shows the next trial
  std::string trial;           ///< key of the next trial
  double seconds = 0;          ///< since the start
  double seconds_left = -1;    ///< estimated from the runs so far; negative: unknown
};

struct MeasureEvents {
  GoOn go_on;                                      ///< returns false to stop at the next row
  std::function<void(const Measuring&)> progress;  ///< before every run
  std::function<void()> save;                      ///< called from time to time to write the measurements so far
};

/// Adds repeats to every trial with is_asked that has fewer than the scale requires. Images of trials with is_compared
/// are compared with `reference` if it is given. Returns false if stopped.
bool measure(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events);

}  // namespace alhazen::impl::study
