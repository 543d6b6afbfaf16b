#include "study/disturbance.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace alhazen::impl::study {

namespace {

bool knows_processor_time(const std::vector<ThreadStatistics>& threads) {
  return std::all_of(threads.begin(), threads.end(), [](const ThreadStatistics& thread) {
    return thread.busy_seconds == 0 || thread.processor_seconds > 0;
  });
}

double fraction_of_slowest(const std::vector<ThreadStatistics>& threads) {
  double lost = 0, longest = 0;
  for (const ThreadStatistics& thread : threads) {
    lost = std::max(lost, thread.busy_seconds - thread.processor_seconds);
    longest = std::max(longest, thread.busy_seconds);
  }
  return longest > 0 ? 1 - lost / longest : 1;
}

/// The number of the processor in a line "cpu3 ..." of /proc/stat; negative for other lines.
int processor_of_line(const std::string& line) {
  constexpr size_t digits = 3;
  const bool is_one = line.starts_with("cpu") && line.size() > digits && line[digits] >= '0' && line[digits] <= '9';
  return is_one ? std::atoi(line.c_str() + digits) : -1;
}

}  // namespace

double processor_fraction(const RunUsage& usage, const std::vector<ThreadStatistics>& threads, int processors) {
  const int count = static_cast<int>(threads.size());
  if (count <= processors && knows_processor_time(threads)) return fraction_of_slowest(threads);
  const double possible = usage.seconds * std::min(count, processors);
  const double lost = possible - usage.processor_seconds - usage.idle_seconds;
  return possible > 0 ? 1 - std::max(0.0, lost) / possible : 1;
}

double idle_seconds() {
  cpu_set_t own;
  CPU_ZERO(&own);
  if (sched_getaffinity(0, sizeof(own), &own) != 0) return 0;
  std::ifstream file("/proc/stat");
  double ticks = 0;
  for (std::string line; std::getline(file, line);) {
    const int processor = processor_of_line(line);
    if (processor < 0 || processor >= CPU_SETSIZE || !CPU_ISSET(static_cast<size_t>(processor), &own)) continue;
    std::istringstream words(line);
    std::string name;
    double user = 0, nice = 0, system = 0, idle = 0, waiting = 0;
    if (words >> name >> user >> nice >> system >> idle >> waiting) ticks += idle + waiting;
  }
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double steady_spread(const std::vector<double>& seconds) {
  if (seconds.empty()) return 0;
  std::vector<double> sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const double median = spread_of(sorted).median;
  sorted.resize(sorted.size() - sorted.size() / 4);
  return median > 0 ? (sorted.back() - sorted.front()) / median : 0;
}

bool is_unsteady(const Trial& trial) { return steady_spread(trial.seconds) > max_steady_spread; }

size_t disturbed_runs(const Trial& trial) {
  return static_cast<size_t>(std::count_if(trial.processor_fractions.begin(), trial.processor_fractions.end(),
                                           [](double fraction) { return fraction < min_processor_fraction; }));
}

std::vector<bool> runs_to_repeat(const Trial& trial) {
  std::vector<bool> repeated(trial.seconds.size());
  std::vector<double> kept;
  for (size_t i = 0; i < repeated.size(); ++i) {
    repeated[i] = trial.processor_fractions[i] < min_processor_fraction;
    if (!repeated[i]) kept.push_back(trial.seconds[i]);
  }
  std::sort(kept.begin(), kept.end());
  while (kept.size() > 1 && steady_spread(kept) > max_steady_spread) kept.pop_back();
  for (size_t i = 0; i < repeated.size(); ++i)
    if (kept.empty() || trial.seconds[i] > kept.back()) repeated[i] = true;
  return repeated;
}

std::string doubt_of(const Trial& trial, int repeats) {
  if (!trial.has_times()) return {};
  const size_t runs = trial.seconds.size(), disturbed = disturbed_runs(trial);
  if (runs < static_cast<size_t>(repeats)) return fmt::format("measured {} of {} times", runs, repeats);
  // The median is that of undisturbed runs if the others are few.
  if (disturbed * 4 > runs) return fmt::format("in {} of {} runs other programs used processors", disturbed, runs);
  if (is_unsteady(trial)) return fmt::format("repeats differ by {:.0f} %", 100 * steady_spread(trial.seconds));
  return {};
}

std::string doubt_of(const Study& study, const Cell& cell) {
  const Trial *trial = study.find(cell.trial), *baseline = study.find(cell.baseline);
  if (!trial || !trial->has_times()) return {};
  if (const std::string doubt = doubt_of(*trial, study.scale.repeats); !doubt.empty()) return doubt;
  if (!baseline || baseline == trial) return {};
  const std::string doubt = doubt_of(*baseline, study.scale.repeats);
  return doubt.empty() ? "" : "its speedup relates to times of which this holds: " + doubt;
}

double trusted_speedup_of(const Study& study, const Table& table, const Cell& cell) {
  return doubt_of(study, cell).empty() ? speedup_of(study, table, cell) : 0;
}

bool are_separated(const Trial& a, const Trial& b, Measure measure) {
  const Spread of_a = spread_of(a.seconds), of_b = spread_of(b.seconds);
  const double unit_a = cost_of(a, measure) / of_a.median, unit_b = cost_of(b, measure) / of_b.median;
  return of_a.min * unit_a > of_b.max * unit_b || of_b.min * unit_b > of_a.max * unit_a;
}

}  // namespace alhazen::impl::study
