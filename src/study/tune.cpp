#include "study/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/film/block_sum.h"
#include "render/backend.h"
#include "study/disturbance.h"

namespace alhazen::impl::study {

namespace {

using Clock = std::chrono::steady_clock;

/// Runs of each candidate per round.
constexpr int runs_a_round = 3;
/// Maximum number of disturbed runs of each candidate per round that are repeated.
constexpr int max_repeated = 3;
/// Maximum number of rounds, each of twice as many samples, to separate the last two.
constexpr int max_final_rounds = 4;
/// Minimum relative gain over the default for another engine to win.
constexpr double min_gain = 0.02;
/// Minimum size of the images: pixels of the shorter side.
constexpr double min_side = 64;

void add_cpu(const Settings& asked, const std::string& backend, std::vector<Candidate>& list) {
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const std::pair<const char*, const char*> strategies[] = {
      {"tiles", "dynamic"}, {"tiles", "dynamic,4"}, {"tiles", "guided"},        {"tiles", "static"},
      {"rows", "dynamic"},  {"rows", "guided"},     {"collapse", "dynamic,64"}, {"collapse", "guided"}};
  std::vector<int> counts{processors};
  if (processors >= 4) counts.push_back(processors / 2);  // processors may be two threads of one core
  for (const int threads : counts)
    for (const auto& [strategy, schedule] : strategies) {
      Candidate candidate;
      candidate.work.settings = asked;
      candidate.work.settings.backend = backend;
      candidate.work.settings.strategy = strategy;
      candidate.work.settings.schedule = schedule;
      candidate.work.settings.threads = threads;
      list.push_back(candidate);
    }
}

void add_cuda(const Settings& asked, std::vector<Candidate>& list) {
  const auto add = [&](const char* strategy, const char* block, const char* chunk) {
    Candidate candidate;
    candidate.work.settings = asked;
    candidate.work.settings.backend = "cuda";
    candidate.work.settings.strategy = strategy;
    candidate.work.settings.block = block;
    candidate.work.settings.chunk = chunk;
    list.push_back(candidate);
  };
  add("persistent", "", "");
  add("wavefront", "", "");
  for (const char* block : {"8x8", "16x16", "16x32", "32x32"}) add("pixel", block, "");
  for (const char* block : {"8x8", "16x16"})
    for (const char* chunk : {"2x2", "4x4", "5x5"}) add("chunk", block, chunk);
}

/// Whether all runs of `a` are faster than all of `b`.
bool is_faster(const Candidate& a, const Candidate& b) {
  return !a.costs.empty() && !b.costs.empty() &&
         *std::max_element(a.costs.begin(), a.costs.end()) < *std::min_element(b.costs.begin(), b.costs.end());
}

class Tuning {
 public:
  Tuning(const Scene& scene, const Settings& asked, double budget, const TuneEvents& events)
      : scene_(scene), asked_(asked), budget_(budget), events_(events) {
    outcome_.candidates = tune_candidates(asked);
  }

  TuneOutcome run() {
    choose_size();
    int64_t samples = samples_per_block;
    std::vector<size_t> running = in_the_running();
    for (int round = 1; events_.go_on() && elapsed() < budget_; ++round, samples *= 2) {
      events_.round(round, running.size(), samples);
      if (!run_round(running, samples)) break;
      std::erase_if(running, [&](size_t i) { return !outcome_.candidates[i].problem.empty(); });
      if (running.empty()) break;
      sort_by_cost(running);
      outcome_.is_complete |= running.size() <= 2;
      if (outcome_.is_complete) {
        if (++final_rounds_ == max_final_rounds || is_decided(running)) break;
        continue;
      }
      running.resize((running.size() + 1) / 2);
      keep_default(running);
    }
    finish();
    return std::move(outcome_);
  }

 private:
  /// Chooses the image size: the scene's own if all candidates can run a first round in a quarter of the budget.
  void choose_size() {
    const RenderSettings settings = resolve_settings(asked_, scene_);
    const double width = settings.width, height = settings.height;
    const double min_scale = std::min(1.0, min_side / std::min(width, height));
    set_size(width, height, min_scale);
    Work first = outcome_.candidates.front().work;
    first.settings.samples_per_pixel = samples_per_block;
    const Clock::time_point start = Clock::now();
    const Outcome small = run_work(first, scene_, false, events_.go_on);
    const double whole = std::chrono::duration<double>(Clock::now() - start).count();
    if (small.status != TrialStatus::ok) return;
    const double rendering = small.statistics.render_seconds, beside = whole - rendering;
    const double runs = static_cast<double>(outcome_.candidates.size()) * (runs_a_round + 1);
    const double fraction = std::max(0.0, budget_ / 4 / runs - beside) / std::max(rendering, 1e-6);
    set_size(width, height, std::clamp(min_scale * std::sqrt(fraction), min_scale, 1.0));
  }

  void set_size(double width, double height, double scale) {
    outcome_.width = std::max<int64_t>(1, std::lround(width * scale));
    outcome_.height = std::max<int64_t>(1, std::lround(height * scale));
    for (Candidate& candidate : outcome_.candidates) {
      candidate.work.settings.width = outcome_.width;
      candidate.work.settings.height = outcome_.height;
    }
  }

  /// What a candidate measured in a round.
  struct Round {
    std::vector<double> costs;
    size_t disturbed = 0;
    int repeated = 0;
  };

  /// Returns false if the budget or the user ended it.
  bool run_round(const std::vector<size_t>& running, int64_t samples) {
    std::vector<Round> rounds(outcome_.candidates.size());
    for (int run = 0; run < runs_a_round; ++run)
      for (const size_t index : running) {
        Candidate& candidate = outcome_.candidates[index];
        Round& round = rounds[index];
        if (!candidate.problem.empty()) continue;
        if (!events_.go_on() || elapsed() > budget_) return keep_round(rounds, run > 0);
        if (candidate.rounds == 0 && run == 0) warm_up(candidate.work, scene_, events_.go_on);
        candidate.work.settings.samples_per_pixel = samples;
        Outcome outcome = run_work(candidate.work, scene_, false, events_.go_on);
        // Not in the first round, which has most engines: the budget must let each of them run.
        while (candidate.rounds > 0 && is_disturbed(outcome) && round.repeated < max_repeated && elapsed() <= budget_) {
          ++round.repeated;
          outcome = run_work(candidate.work, scene_, false, events_.go_on);
        }
        if (outcome.status == TrialStatus::not_run) return keep_round(rounds, run > 0);
        if (outcome.status != TrialStatus::ok) {
          candidate.problem = outcome.reason;
          continue;
        }
        round.costs.push_back(outcome.statistics.render_seconds * 1e9 /
                              static_cast<double>(outcome.statistics.camera_samples));
        round.disturbed += is_disturbed(outcome);
      }
    keep_round(rounds, true);
    return true;
  }

  static bool is_disturbed(const Outcome& outcome) {
    return outcome.status == TrialStatus::ok && outcome.processor_fraction < min_processor_fraction;
  }

  /// Whether further rounds would tell no more about the last two.
  bool is_decided(const std::vector<size_t>& running) const {
    for (const size_t i : running)
      if (outcome_.candidates[i].disturbed > 0) return false;
    return running.size() < 2 || is_faster(outcome_.candidates[running.front()], outcome_.candidates[running.back()]);
  }

  /// Keeps what a round measured if all candidates have run at least once. Always returns false, for the caller to
  /// return.
  bool keep_round(const std::vector<Round>& rounds, bool counts) {
    if (!counts) return false;
    for (size_t i = 0; i < rounds.size(); ++i)
      if (!rounds[i].costs.empty()) {
        outcome_.candidates[i].costs = rounds[i].costs;
        outcome_.candidates[i].disturbed = rounds[i].disturbed;
        ++outcome_.candidates[i].rounds;
      }
    return false;
  }

  std::vector<size_t> in_the_running() const {
    std::vector<size_t> all(outcome_.candidates.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }

  void sort_by_cost(std::vector<size_t>& indices) const {
    std::sort(indices.begin(), indices.end(),
              [&](size_t a, size_t b) { return outcome_.candidates[a].cost() < outcome_.candidates[b].cost(); });
  }

  /// The default is never eliminated, since others must beat it.
  void keep_default(std::vector<size_t>& running) const {
    for (size_t i = 0; i < outcome_.candidates.size(); ++i)
      if (outcome_.candidates[i].is_default && outcome_.candidates[i].problem.empty() &&
          std::find(running.begin(), running.end(), i) == running.end())
        running.back() = i;
  }

  void finish() {
    std::vector<Candidate>& list = outcome_.candidates;
    std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
      if (a.problem.empty() != b.problem.empty()) return a.problem.empty();
      if (a.rounds != b.rounds) return a.rounds > b.rounds;
      return a.cost() < b.cost();
    });
    outcome_.seconds = elapsed();
    outcome_.winner = 0;
    for (size_t i = 0; i < list.size(); ++i)
      if (list[i].is_default && list[i].problem.empty() && list[i].rounds > 0 &&
          list[i].cost() * (1 - min_gain) <= list[0].cost())
        outcome_.winner = i;
    if (list.empty() || !list[0].problem.empty())
      throw InputError("no engine can render this scene here: " + (list.empty() ? "there is none" : list[0].problem));
    if (list[0].rounds == 0 && events_.go_on())
      throw InputError("the budget was over before every engine had run: give a larger --budget");
  }

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  const Scene& scene_;
  const Settings& asked_;
  double budget_;
  const TuneEvents& events_;
  TuneOutcome outcome_;
  int final_rounds_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

size_t TuneOutcome::open() const {
  return static_cast<size_t>(std::count_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
    return c.problem.empty() && c.rounds == candidates[winner].rounds;
  }));
}

std::string why_not_to_store(const TuneOutcome& outcome) {
  if (!outcome.is_complete)
    return fmt::format("the budget ended while {} engines were left: give a larger --budget", outcome.open());
  const Candidate& winner = outcome.candidates[outcome.winner];
  for (size_t i = 0; i < outcome.candidates.size(); ++i) {
    const Candidate& other = outcome.candidates[i];
    if (!other.problem.empty() || other.rounds != winner.rounds) continue;
    if (other.disturbed > 0)
      return fmt::format("other programs used the processors in {} of the last {} runs of {}: tune on a quiet machine",
                         other.disturbed, other.costs.size(), command_options(other.work));
    if (i != outcome.winner && !is_faster(winner, other))
      return fmt::format(
          "the last two engines differ no more than their runs do, {:.1f} and {:.1f} ns per sample: "
          "without an entry, --backend auto takes its own choice, which is as fast",
          winner.cost(), other.cost());
  }
  return {};
}

double Candidate::cost() const { return costs.empty() ? 0 : spread_of(costs).median; }

std::vector<Candidate> tune_candidates(const Settings& asked) {
  std::vector<Candidate> list;
  if (std::thread::hardware_concurrency() <= 1) {
    Candidate serial;
    serial.work.settings = asked;
    serial.work.settings.backend = "serial";
    list.push_back(serial);
  }
  for (const auto& backend : all_backends()) {
    const BackendTraits d = backend->traits();
    if (!backend->status().available || d.name == "serial" || (asked.precision == "double" && !d.traces_double))
      continue;
    if (!d.runs_on_devices)
      add_cpu(asked, d.name, list);
    else if (d.name == "cuda")
      add_cuda(asked, list);
    else {
      Candidate candidate;
      candidate.work.settings = asked;
      candidate.work.settings.backend = d.name;
      list.push_back(candidate);
    }
  }
  // The candidate that choose_backend selects for `auto` is the first of the list.
  if (!list.empty()) list.front().is_default = true;
  return list;
}

TuneOutcome tune(const Scene& scene, const Settings& asked, double budget, const TuneEvents& events) {
  return Tuning(scene, asked, budget, events).run();
}

}  // namespace alhazen::impl::study
