#pragma once

// Plans the trials of a study and the tables that show them.

#include "study/study.h"

namespace alhazen::impl::study {

/// Collects trials and tables. Equal work is one trial, however many cells show it.
class Plan {
 public:
  explicit Plan(Study& study) : study_(study) {}

  /// Returns the key of the trial of that work.
  std::string add(const Work& work);
  Table& add(Table table);
  const Scale& scale() const { return study_.scale; }
  const SceneFacts& scene() const { return study_.scene; }
  int processors() const { return study_.machine.processors; }
  std::vector<int> thread_counts() const;

  /// CPU settings at the study's scale, with `iterative` and the scene's D.
  Work on_cpu(const std::string& backend, const std::string& precision, int threads) const;
  Work on_gpu(const std::string& backend, const std::string& precision) const;
  /// The same, a path at a time: every form of the report's loops then runs the same kernel, and takes no advantage of
  /// batches, which are as large as its loops allow.
  Work path_at_a_time(const std::string& backend, const std::string& precision, int threads) const;
  /// One core, `iterative`, a path at a time: what the speedups of the report's tables relate to.
  std::string one_core(const std::string& precision) { return add(path_at_a_time("serial", precision, 1)); }
  /// The same in batches: the fastest that one core does.
  std::string one_core_in_batches(const std::string& precision) { return add(on_cpu("serial", precision, 1)); }
  /// The edge of a square image with 4 samples per pixel for a linear scan over that many objects.
  int64_t linear_size(uint64_t objects, int64_t largest) const;

 private:
  Study& study_;
};

/// Adds a cell to a row of one of the report's tables, with the report's own figures.
void add_cell(Table& table, const std::string& row, const std::string& column, const std::string& trial,
              const std::string& baseline, const std::string& note = {});

/// Tables 1 to 5 and OptiX.
void plan_report(Plan& plan);
/// Measurements beyond the report.
void plan_beyond(Plan& plan);
/// Makes the trials and tables of the study, for its machine, scene and scale.
void plan_study(Study& study);

}  // namespace alhazen::impl::study
