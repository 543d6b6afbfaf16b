#pragma once

// A study: measurements, the tables that show them, and their circumstances. All output (study.json, tables, the page)
// is made from it.

#include <string>
#include <vector>

#include "study/machine.h"
#include "study/trial.h"
#include "study/work_per_thread.h"

namespace alhazen::impl::study {

/// The report's figures for a cell: seconds on its machines; speedups over serial in the same precision.
struct ReportFigure {
  std::string machine;  ///< cuda2 or cuda3
  double seconds = 0;   ///< 0: it could not run
  double speedup = 0;   ///< 0: none given
};

/// A cell of a table. Trials are referred to by their keys.
struct Cell {
  std::string row, column;
  std::string trial;
  std::string baseline;  ///< the trial to which the speedup is relative; empty: no speedup
  std::vector<ReportFigure> report;
  std::string note;  ///< a remark about this cell alone
};

/// The quantity in a cell: seconds, time per ray, ... Speedups are ratios of time per sample, or per ray.
enum class Measure { seconds, nanoseconds_per_ray, load_balance, error };
std::string to_string(Measure measure);

struct Table {
  std::string id;     ///< table1, ...
  std::string title;  ///< a line
  std::string text;   ///< what was run, and what is comparable with the report
  std::string row_title;
  Measure measure = Measure::seconds;
  std::vector<std::string> columns;
  std::vector<Cell> cells;
  bool shows_rays = false;  ///< whether cells also show rays per camera sample

  std::vector<std::string> rows() const;
  const Cell* find(const std::string& row, const std::string& column) const;
};

/// The amount of work; the same on every machine.
struct Scale {
  std::string name = "default";
  int64_t width = 400, height = 400, samples = 20;     ///< CPU, on the study's scene; 0: as in the scene
  int64_t gpu_samples = 256;                           ///< GPUs render the scene's own size
  int64_t depth_size = 128, depth_samples = 4;         ///< depth against cost
  int64_t objects_size = 128, objects_samples = 16;    ///< cost against objects
  uint64_t linear_tests = 1'000'000'000;               ///< number of objects times rays for a linear scan
  int64_t error_size = 200, reference_samples = 2048;  ///< time to equal error
  int64_t image_samples = 256, bounces_samples = 64;   ///< Figures 2 and 3, at the scene's own size
  int repeats = 5;
};

Scale quick_scale();
Scale default_scale();
Scale full_scale();

struct SceneFacts {
  std::string name;  ///< of the file, without its folder
  std::string hash;  ///< of the compiled scene
  int64_t width = 0, height = 0;
  int64_t segments = 0;  ///< D
  uint64_t spheres = 0, triangles = 0, lights = 0;
};

/// The state of the machine while a round was measured.
struct Conditions {
  double seconds = 0;  ///< since the start
  double load = 0;     ///< running or waiting processes over a minute, including the study's own threads
  double megahertz = 0;
};

struct Study {
  std::string date;
  Machine machine;
  SceneFacts scene;
  Scale scale;
  std::vector<Trial> trials;
  std::vector<Table> tables;
  WorkPerThread work_per_thread;
  std::vector<Conditions> conditions;
  double seconds = 0;  ///< total time of the study
  bool is_complete = false;

  /// Runs of all trials, without those that cannot be run.
  size_t runs_measured() const;
  size_t runs_planned() const;
  const Trial* find(const std::string& key) const;
  const Table* table(const std::string& id) const;
};

/// Median time per camera sample, or per ray. The trial must have times.
double cost_of(const Trial& trial, Measure measure);
/// Speedup of a cell over its baseline; 0 if there is nothing to compare.
double speedup_of(const Study& study, const Table& table, const Cell& cell);
/// The busiest thread's time over the mean, and the Gini coefficient; medians over the repeats.
double busiest_over_mean(const Trial& trial);
double gini_of_busy(const Trial& trial);

}  // namespace alhazen::impl::study
