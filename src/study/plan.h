#pragma once

// Which trials a study has and which tables they are laid out in.

#include "study/study.h"

namespace alhazen::study {

/// Collects trials and tables. The same work is one trial, however many cells show it.
class Plan {
 public:
  explicit Plan(Study& study) : study_(study) {}

  /// The key of the trial of that work.
  std::string add(const Work& work);
  Table& add(Table table);
  const Scale& scale() const { return study_.scale; }
  const SceneFacts& scene() const { return study_.scene; }
  int processors() const { return study_.machine.processors; }
  std::vector<int> thread_counts() const;

  /// Settings of a CPU at the scale, in `iterative` and D of the scene.
  Work on_cpu(const std::string& backend, const std::string& precision, int threads) const;
  Work on_gpu(const std::string& backend, const std::string& precision) const;
  /// Serial and `iterative`: what speedups are over.
  std::string serial(const std::string& precision) { return add(on_cpu("serial", precision, 1)); }
  /// The edge of a square picture of 4 samples a pixel that a linear scan over so many objects is given.
  int64_t linear_size(uint64_t objects, int64_t largest) const;

 private:
  Study& study_;
};

/// A cell in a row of one of the report's tables, with the report's own figures beside it.
void add_cell(Table& table, const std::string& row, const std::string& column, const std::string& trial,
              const std::string& baseline, const std::string& note = {});

/// Tables 1 to 5 and OptiX.
void plan_report(Plan& plan);
/// What the report lacks.
void plan_beyond(Plan& plan);
/// Sets trials and tables of the study, for its machine, scene and scale.
void plan_study(Study& study);

}  // namespace alhazen::study
