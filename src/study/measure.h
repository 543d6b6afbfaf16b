#pragma once

// Measures the trials of a study in rounds: each round runs every trial once, in another order, so that whatever
// changes on the machine meanwhile meets all of them alike.

#include <functional>

#include "study/run_work.h"
#include "study/study.h"

namespace alhazen::study {

struct Measuring {
  int round = 1, rounds = 1;
  size_t done = 0, total = 0;  ///< runs, over all rounds; those that cannot be made are not counted
  std::string trial;           ///< the key of the one that is next
  double seconds = 0;          ///< since the start
  double seconds_left = -1;    ///< by what the runs so far took; negative: not known yet
};

struct MeasureEvents {
  GoOn go_on;                                      ///< false stops at the next row
  std::function<void(const Measuring&)> progress;  ///< before every run
  std::function<void()> save;                      ///< now and then: what there is may be written
};

/// Adds repeats to every trial that has fewer than the scale asks for. `reference`, where there is one, is what
/// pictures of trials with is_compared are compared with. False: it was stopped.
bool measure(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events);

}  // namespace alhazen::study
