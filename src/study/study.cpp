#include "study/study.h"

#include <algorithm>

namespace alhazen::impl::study {

std::string to_string(Measure measure) {
  switch (measure) {
    case Measure::seconds:
      return "seconds";
    case Measure::nanoseconds_per_ray:
      return "nanoseconds per ray";
    case Measure::load_balance:
      return "busiest thread over mean";
    case Measure::error:
      break;
  }
  return "RMSE";
}

std::vector<std::string> Table::rows() const {
  std::vector<std::string> names;
  for (const Cell& cell : cells)
    if (std::find(names.begin(), names.end(), cell.row) == names.end()) names.push_back(cell.row);
  return names;
}

const Cell* Table::find(const std::string& row, const std::string& column) const {
  for (const Cell& cell : cells)
    if (cell.row == row && cell.column == column) return &cell;
  return nullptr;
}

Scale quick_scale() {
  Scale s;
  s.name = "quick";
  s.width = s.height = 200;
  s.samples = 24;
  s.gpu_samples = 64;
  s.depth_size = 64;
  s.objects_size = 100;
  s.objects_samples = 8;
  s.linear_tests = 200'000'000;
  s.error_size = 120;
  s.reference_samples = 1024;
  s.image_samples = 32;
  s.bounces_samples = 16;
  s.repeats = 3;
  return s;
}

Scale default_scale() { return {}; }

Scale full_scale() {
  Scale s;
  s.name = "full";
  s.width = s.height = 0;
  s.samples = s.gpu_samples = s.image_samples = 1000;
  s.depth_size = 400;
  s.depth_samples = 16;
  s.objects_size = 400;
  s.linear_tests = 10'000'000'000;
  s.error_size = 400;
  s.reference_samples = 8192;
  s.bounces_samples = 256;
  s.repeats = 3;
  return s;
}

size_t Study::runs_measured() const {
  size_t runs = 0;
  for (const Trial& trial : trials) runs += std::min(trial.seconds.size(), static_cast<size_t>(scale.repeats));
  return runs;
}

size_t Study::runs_planned() const {
  const auto can_run = [](const Trial& t) { return t.status == TrialStatus::not_run || t.status == TrialStatus::ok; };
  return static_cast<size_t>(std::count_if(trials.begin(), trials.end(), can_run)) * static_cast<size_t>(scale.repeats);
}

const Trial* Study::find(const std::string& key) const {
  const auto at = std::find_if(trials.begin(), trials.end(), [&](const Trial& t) { return t.key == key; });
  return at == trials.end() ? nullptr : &*at;
}

const Table* Study::table(const std::string& id) const {
  const auto at = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.id == id; });
  return at == tables.end() ? nullptr : &*at;
}

double cost_of(const Trial& trial, Measure measure) {
  const uint64_t units = measure == Measure::nanoseconds_per_ray ? trial.rays + trial.shadow_rays : trial.samples;
  return units > 0 ? spread_of(trial.seconds).median / static_cast<double>(units) : 0;
}

double speedup_of(const Study& study, const Table& table, const Cell& cell) {
  const Trial *trial = study.find(cell.trial), *baseline = study.find(cell.baseline);
  if (!trial || !baseline || !trial->has_times() || !baseline->has_times()) return 0;
  const double cost = cost_of(*trial, table.measure);
  return cost > 0 ? cost_of(*baseline, table.measure) / cost : 0;
}

namespace {

/// The median over the repeats of a number computed from the threads' busy seconds.
template <class Number>
double median_over_repeats(const Trial& trial, const Number& number) {
  std::vector<double> values;
  for (const std::vector<double>& busy : trial.busy_seconds) values.push_back(number(busy));
  return values.empty() ? 0 : spread_of(values).median;
}

}  // namespace

double busiest_over_mean(const Trial& trial) {
  return median_over_repeats(trial, [](const std::vector<double>& busy) {
    double sum = 0, longest = 0;
    for (const double seconds : busy) {
      sum += seconds;
      longest = std::max(longest, seconds);
    }
    return sum > 0 ? longest * static_cast<double>(busy.size()) / sum : 0;
  });
}

double gini_of_busy(const Trial& trial) {
  return median_over_repeats(trial, [](const std::vector<double>& busy) { return gini(busy); });
}

}  // namespace alhazen::impl::study
