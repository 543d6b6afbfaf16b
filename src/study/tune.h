#pragma once

// `alhazen study tune`: finds the fastest engine for a scene on this machine. All available engines take a few samples;
// the slower half is eliminated, the others take twice as many, and so on (successive halving; Jamieson, Talwalkar
// 2016), within a budget.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "study/run_work.h"

namespace alhazen::impl::study {

struct Candidate {
  Work work;
  std::string problem;        ///< why it cannot compete; empty if it can
  std::vector<double> costs;  ///< nanoseconds per sample, in its last round
  size_t disturbed = 0;       ///< number of those runs that other programs disturbed
  int rounds = 0;             ///< number of its rounds
  bool is_default = false;    ///< selected by `--backend auto` without tuning

  double cost() const;  ///< the median
};

struct TuneOutcome {
  std::vector<Candidate> candidates;  ///< sorted by number of rounds, then by speed
  size_t winner = 0;                  ///< the default unless another is faster beyond noise
  int64_t width = 0, height = 0;      ///< of the timed images
  double seconds = 0;
  bool is_complete = false;  ///< false if the budget ended before two were left

  /// Number of engines that ran in the last round.
  size_t open() const;
};

/// Why the winner should not be stored: too many engines were left, other programs disturbed its runs or those of the
/// other one, or not all of its runs are faster. Empty if it may be.
std::string why_not_to_store(const TuneOutcome& outcome);

struct TuneEvents {
  GoOn go_on;
  std::function<void(int round, size_t candidates, int64_t samples)> round;
};

/// The candidates on this machine, for the precision and integrator of `asked`.
std::vector<Candidate> tune_candidates(const Settings& asked);

/// `budget` in seconds. Throws InputError if nothing can render the scene, or not within the budget. If the user ended
/// it before every engine had run, no candidate has a cost.
TuneOutcome tune(const Scene& scene, const Settings& asked, double budget, const TuneEvents& events);

}  // namespace alhazen::impl::study
