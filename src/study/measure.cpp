#include "study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "study/disturbance.h"

namespace alhazen::impl::study {

namespace {

using Clock = std::chrono::steady_clock;

/// Maximum time between saves of the measurements, seconds. A study that is killed loses no more.
constexpr double save_interval = 2;

/// Maximum number of runs of a trial that are replaced because other programs disturbed them.
size_t max_disturbed(const Scale& scale) { return static_cast<size_t>(scale.repeats); }

bool lacks_runs(const Trial& trial, const Scale& scale) { return trial.is_asked && trial.lacks_runs(scale.repeats); }

/// Whether repeats of a trial that has them all differ so much that another one is to replace the slowest.
bool is_to_repeat(const Trial& trial, const Scale& scale) {
  return trial.is_asked && trial.has_times() && is_unsteady(trial) &&
         trial.disturbed_seconds.size() < max_disturbed(scale);
}

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

/// Keeps the time of a run, and removes the slowest one if there is one too many.
void add_run(const Outcome& outcome, int repeats, Trial& trial) {
  const RenderStatistics& s = outcome.statistics;
  std::vector<double> busy;
  for (const ThreadStatistics& thread : s.threads) busy.push_back(thread.busy_seconds);
  trial.seconds.push_back(s.render_seconds);
  trial.busy_seconds.push_back(std::move(busy));
  trial.processor_fractions.push_back(outcome.processor_fraction);
  trial.switches.push_back(outcome.switches);
  if (trial.seconds.size() <= static_cast<size_t>(repeats)) return;
  const auto slowest = std::max_element(trial.seconds.begin(), trial.seconds.end());
  trial.disturbed_seconds.push_back(*slowest);
  trial.erase_run(static_cast<size_t>(slowest - trial.seconds.begin()));
}

/// Returns false if the run was disturbed and must be repeated.
bool record(const Outcome& outcome, const Image* reference, const Study& study, Trial& trial) {
  if (outcome.status != TrialStatus::ok) {
    trial.status = outcome.status;
    trial.reason = outcome.reason;
    return true;
  }
  const RenderStatistics& s = outcome.statistics;
  const size_t max = max_disturbed(study.scale);
  if (outcome.processor_fraction < min_processor_fraction && trial.disturbed_seconds.size() < max) {
    trial.disturbed_seconds.push_back(s.render_seconds);
    return false;
  }
  // Set only now: a trial that is ok has times, even if the study is interrupted.
  trial.status = TrialStatus::ok;
  trial.reason.clear();
  add_run(outcome, study.scale.repeats, trial);
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

/// "Table 3: 4 dynamic, float" for the first cell that shows a trial.
std::string cell_of(const Study& study, const std::string& trial) {
  for (const Table& table : study.tables)
    for (const Cell& cell : table.cells)
      if (cell.trial == trial)
        return fmt::format("{}: {}, {}", table.title.starts_with("Table ") ? table.title.substr(0, 7) : table.id,
                           cell.row, cell.column);
  return "what speedups relate to";
}

class Rounds {
 public:
  Rounds(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events)
      : study_(study), scene_(scene), reference_(reference), events_(events) {
    now_.rounds = study.scale.repeats;
    for (const Trial& trial : study.trials)
      if (lacks_runs(trial, study.scale)) now_.total += static_cast<size_t>(study.scale.repeats) - trial.seconds.size();
  }

  bool run() {
    // Further rounds repeat disturbed runs.
    const int max_rounds = now_.rounds + static_cast<int>(max_disturbed(study_.scale));
    for (now_.round = 1; now_.round <= max_rounds; ++now_.round) {
      if (!run_round()) return false;
      if (has_unsaved_) save();
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
      const bool is_repeated = now_.round > now_.rounds && is_to_repeat(trial, study_.scale);
      if (!is_repeated && (!lacks_runs(trial, study_.scale) || tries >= static_cast<size_t>(now_.round))) continue;
      if (is_repeated) ++now_.total;
      if (done++ == 0) study_.conditions.push_back({start, load_average(), megahertz()});
      if (!run_trial(trial)) return false;
      if (has_unsaved_ && elapsed() - saved_ > save_interval) save();
    }
    return true;
  }

  void save() {
    events_.save();
    has_unsaved_ = false;
    saved_ = elapsed();
  }

  bool run_trial(Trial& trial) {
    now_.cell = cell_of(study_, trial.key);
    now_.trial = trial.key;
    now_.seconds = elapsed();
    // Runs that were disturbed take time as well.
    if (tries_ > 0)
      now_.seconds_left = now_.seconds / static_cast<double>(tries_) *
                          static_cast<double>(now_.total - std::min(now_.done, now_.total));
    ++tries_;
    events_.progress(now_);
    if (warm_.insert(trial.key).second) warm_up(trial.work, scene_, events_.go_on);
    if (!events_.go_on()) return false;
    const Outcome outcome = run_work(trial.work, scene_, trial.work.is_compared && trial.rmse < 0, events_.go_on);
    if (outcome.status == TrialStatus::not_run) return false;
    const bool counts = record(outcome, reference_, study_, trial);
    has_unsaved_ |= counts;
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
  bool has_unsaved_ = false;
  size_t tries_ = 0;  ///< runs so far, also those that were disturbed
};

}  // namespace

bool measure(Study& study, const Scene& scene, const Image* reference, const MeasureEvents& events) {
  return Rounds(study, scene, reference, events).run();
}

}  // namespace alhazen::impl::study
