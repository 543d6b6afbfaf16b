#pragma once

// `alhazen study tune`: the fastest engine for a scene, here. All that there are take a few samples; the slower half
// drops out, the others take twice as many, and so on (successive halving; Jamieson, Talwalkar 2016), within a budget.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "study/run_work.h"

namespace alhazen::study {

struct Candidate {
  Work work;
  std::string problem;        ///< why it is out of the running; empty: it is not
  std::vector<double> costs;  ///< nanoseconds a sample, of the last round that it was in
  int rounds = 0;             ///< that it was in
  bool is_default = false;    ///< what `--backend auto` takes of itself

  double cost() const;  ///< the median
};

struct TuneOutcome {
  std::vector<Candidate> candidates;  ///< the longer in the running, then the faster, first
  size_t winner = 0;                  ///< the default unless another is faster beyond noise
  int64_t width = 0, height = 0;      ///< of the pictures that were timed
  double seconds = 0;
  bool is_complete = false;  ///< false: the budget ended it before two were left
};

struct TuneEvents {
  GoOn go_on;
  std::function<void(int round, size_t candidates, int64_t samples)> round;
};

/// What could be tried here, for the precision and integrator of `asked`.
std::vector<Candidate> tune_candidates(const Settings& asked);

/// `budget` in seconds. Throws InputError where nothing can render the scene, or not within the budget. Where the user
/// ended it before every engine had a turn, no candidate has a cost.
TuneOutcome tune(const Scene& scene, const Settings& asked, double budget, const TuneEvents& events);

}  // namespace alhazen::study
