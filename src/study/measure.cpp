#include "study/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace alhazen::study {

namespace {

using Clock = std::chrono::steady_clock;

/// Maximum time between saves of the measurements, seconds.
constexpr double save_interval = 20;

/// Maximum number of runs of a trial that are repeated because other programs used the processors.
size_t max_disturbed(const Scale& scale) { return (static_cast<size_t>(scale.repeats) + 2) / 3; }

bool is_wanted(const Trial& trial, const Scale& scale) { return trial.is_asked && trial.lacks_runs(scale.repeats); }

/// Over R, G, B; pixels that are not finite count as black.
double rmse_of(const Image& image, const Image& reference) {
  double sum = 0;
  size_t count = 0;
  for (size_t channel = 0; channel < 3; ++channel)
    for (size_t i = 0; i < reference.planes[channel].size(); ++i) {
      const double value = static_cast<double>(image.planes[channel][i]);
      const double difference = (std::isfinite(value) ? value : 0) - static_cast<double>(reference.planes[channel][i]);
      sum += difference * difference;
      ++count;
    }
  return std::sqrt(sum / static_cast<double>(count));
}

/// Returns false if the run was disturbed and must be repeated.
bool record(const Outcome& outcome, const Image* reference, const Study& study, Trial& trial) {
  if (outcome.status != TrialStatus::ok) {
    trial.status = outcome.status;
    trial.reason = outcome.reason;
    return true;
  }
  const RenderStatistics& s = outcome.statistics;
  std::vector<double> busy;
  for (const ThreadStatistics& thread : s.threads) busy.push_back(thread.busy_seconds);
  const double fraction = s.settings.runs_on_device ? 1
                                                    : processor_fraction(outcome.processor_seconds, s.render_seconds,
                                                                         busy, study.machine.processors);
  if (fraction < min_processor_fraction && trial.disturbed_seconds.size() < max_disturbed(study.scale)) {
    trial.disturbed_seconds.push_back(s.render_seconds);
    return false;
  }
  // Set only now: a trial that is ok has times, even if the study is interrupted.
  trial.status = TrialStatus::ok;
  trial.reason.clear();
  trial.seconds.push_back(s.render_seconds);
  trial.busy_seconds.push_back(std::move(busy));
  trial.processor_fractions.push_back(fraction);
  trial.build_seconds = s.build_seconds;
  trial.width = s.settings.window.width();
  trial.height = s.settings.window.height();
  trial.samples_per_pixel = s.samples_per_pixel;
  trial.samples = s.camera_samples;
  trial.rays = s.rays;
  trial.shadow_rays = s.shadow_rays;
  if (outcome.image && reference) trial.rmse = rmse_of(*outcome.image, *reference);
  return true;
}

class Rounds {
 public:
  Rounds(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events)
      : study_(study), scene_(scene), reference_(reference), events_(events) {
    now_.rounds = study.scale.repeats;
    for (const Trial& trial : study.trials)
      if (is_wanted(trial, study.scale)) now_.total += static_cast<size_t>(study.scale.repeats) - trial.seconds.size();
  }

  bool run() {
    // Further rounds repeat disturbed runs.
    const int max_rounds = now_.rounds + static_cast<int>(max_disturbed(study_.scale));
    for (now_.round = 1; now_.round <= max_rounds; ++now_.round) {
      if (!run_round()) return false;
      events_.save();
    }
    return true;
  }

 private:
  bool run_round() {
    const double start = elapsed();
    size_t done = 0;
    for (const size_t index : order_of_round()) {
      Trial& trial = study_.trials[index];
      const size_t tries = trial.seconds.size() + trial.disturbed_seconds.size();
      if (!is_wanted(trial, study_.scale) || tries >= static_cast<size_t>(now_.round)) continue;
      if (done++ == 0) study_.conditions.push_back({start, load_average(), megahertz()});
      if (!run_trial(trial)) return false;
      if (elapsed() - saved_ > save_interval) {
        events_.save();
        saved_ = elapsed();
      }
    }
    return true;
  }

  bool run_trial(Trial& trial) {
    now_.trial = trial.key;
    now_.seconds = elapsed();
    // The first runs include a warm-up and overestimate the time left, so the second round uses its own times.
    if (now_.done > 0)
      now_.seconds_left = now_.seconds / static_cast<double>(now_.done) *
                          static_cast<double>(now_.total - std::min(now_.done, now_.total));
    events_.progress(now_);
    if (warm_.insert(trial.key).second) warm_up(trial.work, scene_, events_.go_on);
    if (!events_.go_on()) return false;
    const Outcome outcome = run_work(trial.work, scene_, trial.work.is_compared && trial.rmse < 0, events_.go_on);
    if (outcome.status == TrialStatus::not_run) return false;
    const bool counts = record(outcome, reference_, study_, trial);
    if (outcome.status != TrialStatus::ok)
      now_.total -= std::min(now_.total - now_.done, static_cast<size_t>(study_.scale.repeats) - trial.seconds.size());
    else if (counts)
      ++now_.done;
    return true;
  }

  /// The order of a round, the same in every study.
  std::vector<size_t> order_of_round() const {
    std::vector<size_t> order(study_.trials.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::mt19937 random(static_cast<uint32_t>(now_.round));
    std::shuffle(order.begin(), order.end(), random);
    return order;
  }

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Study& study_;
  const Scene& scene_;
  const Image* reference_;
  const MeasureEvents& events_;
  Measuring now_;
  std::set<std::string> warm_;
  Clock::time_point start_ = Clock::now();
  double saved_ = 0;
};

}  // namespace

bool measure(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events) {
  return Rounds(study, scene, reference, events).run();
}

}  // namespace alhazen::study
