#include "study/plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "study/report_figures.h"

namespace alhazen::impl::study {

std::string Plan::add(const Work& work) {
  const std::string key = command_options(work);
  if (!study_.find(key)) {
    Trial trial;
    trial.key = key;
    trial.work = work;
    study_.trials.push_back(std::move(trial));
  }
  return key;
}

Table& Plan::add(Table table) {
  study_.tables.push_back(std::move(table));
  return study_.tables.back();
}

std::vector<int> Plan::thread_counts() const {
  std::set<int> counts{4, 8, 12, processors()};
  for (int count = 2; count < processors(); count *= 2) counts.insert(count);
  return {counts.begin(), counts.end()};
}

Work Plan::on_cpu(const std::string& backend, const std::string& precision, int threads) const {
  Work work;
  work.settings.backend = backend;
  work.settings.precision = precision;
  if (backend != "serial") work.settings.threads = threads;
  work.settings.integrator = "iterative";
  work.settings.width = scale().width;
  work.settings.height = scale().height;
  work.settings.samples_per_pixel = scale().samples;
  return work;
}

Work Plan::path_at_a_time(const std::string& backend, const std::string& precision, int threads) const {
  Work work = on_cpu(backend, precision, threads);
  work.queries = Queries::path_at_a_time;
  return work;
}

Work Plan::on_gpu(const std::string& backend, const std::string& precision) const {
  Work work;
  work.settings.backend = backend;
  work.settings.precision = precision;
  work.settings.integrator = "iterative";
  work.settings.samples_per_pixel = scale().gpu_samples;
  return work;
}

int64_t Plan::linear_size(uint64_t objects, int64_t largest) const {
  constexpr double rays_a_pixel = 2.5 * 4;
  const double pixels = static_cast<double>(scale().linear_tests) / (rays_a_pixel * static_cast<double>(objects));
  // Infinite for a scene without objects.
  return static_cast<int64_t>(std::clamp(std::sqrt(pixels), 8.0, std::max(8.0, static_cast<double>(largest))));
}

void add_cell(Table& table, const std::string& row, const std::string& column, const std::string& trial,
              const std::string& baseline, const std::string& note) {
  table.cells.push_back({row, column, trial, baseline, report_figures(table.id, row, column), note});
}

void plan_study(Study& study) {
  study.trials.clear();
  study.tables.clear();
  Plan plan(study);
  plan_report(plan);
  plan_beyond(plan);
}

}  // namespace alhazen::impl::study
