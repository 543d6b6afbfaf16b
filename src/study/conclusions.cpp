#include "study/conclusions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "study/cell_text.h"
#include "study/names.h"
#include "study/report_figures.h"

namespace alhazen::study {

namespace {

/// The measured trial of a cell, or null.
const Trial* trial_at(const Study& study, const std::string& table_id, const std::string& row,
                      const std::string& column) {
  const Table* table = study.table(table_id);
  const Cell* cell = table ? table->find(row, column) : nullptr;
  const Trial* trial = cell ? study.find(cell->trial) : nullptr;
  return trial && trial->has_times() ? trial : nullptr;
}

double speedup_at(const Study& study, const std::string& table_id, const std::string& row, const std::string& column) {
  const Table* table = study.table(table_id);
  const Cell* cell = table ? table->find(row, column) : nullptr;
  return cell ? speedup_of(study, *table, *cell) : 0;
}

/// The fastest row of a table in a column, and its speedup.
std::pair<std::string, double> fastest_row(const Study& study, const std::string& table_id, const std::string& column) {
  std::pair<std::string, double> best;
  const Table* table = study.table(table_id);
  if (!table) return best;
  for (const Cell& cell : table->cells) {
    const double speedup = cell.column == column ? speedup_of(study, *table, cell) : 0;
    if (speedup > best.second) best = {cell.row, speedup};
  }
  return best;
}

/// Words for a / b that are correct whether the ratio is above or below 1.
std::string compared(double ratio, const std::string& faster, const std::string& slower) {
  return ratio >= 1 ? fmt::format("{} times {}", short_number(ratio), faster)
                    : fmt::format("{} times {}", short_number(1 / ratio), slower);
}

class Conclusions {
 public:
  explicit Conclusions(const Study& study) : study_(study), all_(std::to_string(study.machine.processors)) {}

  std::vector<Conclusion> take() {
    precision();
    schedule();
    forms();
    crowding();
    gpus();
    figure3();
    queries();
    objects();
    depth();
    glass();
    error();
    return std::move(list_);
  }

 private:
  /// Adds a conclusion, with a remark if its runs were disturbed.
  void add(const std::string& title, const std::string& text, const char* table_id = "") {
    const bool is_disturbed = has_disturbed_runs(table_id);
    list_.push_back({title, text + (is_disturbed ? " (Other programs disturbed some of these runs.)" : "")});
  }

  bool has_disturbed_runs(const char* table_id) const {
    const Table* table = study_.table(table_id);
    if (!table) return false;
    for (const Cell& cell : table->cells)
      for (const double fraction : study_.find(cell.trial)->processor_fractions)
        if (fraction < min_processor_fraction) return true;
    return false;
  }

  void precision() {
    const Trial* in_float = trial_at(study_, "table1", name::iterative, "float");
    const Trial* in_double = trial_at(study_, "table1", name::iterative, "double");
    if (!in_float || !in_double) return;
    const double ratio = cost_of(*in_double, Measure::seconds) / cost_of(*in_float, Measure::seconds);
    std::string text = fmt::format("On one core double takes {:.2f} times as long as float.", ratio);
    const std::vector<ReportFigure> floats = report_figures("table1", name::recursive, "float"),
                                    doubles = report_figures("table1", name::recursive, "double");
    for (size_t i = 0; i < floats.size() && i < doubles.size(); ++i)
      text += fmt::format("{}{:.2f} times as long on {}", i == 0 ? " In the report it took " : " and ",
                          doubles[i].seconds / floats[i].seconds, floats[i].machine);
    add("Precision.", text + (floats.empty() ? "" : "."));
  }

  void schedule() {
    const double fixed = speedup_at(study_, "table3", all_ + " static", "float");
    const double dynamic = speedup_at(study_, "table3", all_ + " dynamic", "float");
    if (fixed == 0 || dynamic == 0) return;
    std::string text =
        fmt::format("On {} threads a dynamic schedule of rows is {} a static one: {} against {} over one core.", all_,
                    compared(dynamic / fixed, "as fast as", "slower than"), times_text(dynamic), times_text(fixed));
    const Trial* busy_static = trial_at(study_, "balance", "rows static", "float");
    const Trial* busy_dynamic = trial_at(study_, "balance", "rows dynamic", "float");
    if (busy_static && busy_dynamic)
      text += fmt::format(
          " Why: with the static one the busiest thread works {:.2f} times the mean, with the dynamic one {:.2f} "
          "times.",
          busiest_over_mean(*busy_static), busiest_over_mean(*busy_dynamic));
    add("Schedule.", text, "table3");
  }

  void forms() {
    const Table* table = study_.table("table2");
    if (!table) return;
    std::vector<std::pair<double, std::string>> order;
    for (const Cell& cell : table->cells)
      if (const double speedup = speedup_of(study_, *table, cell); speedup > 0) order.emplace_back(speedup, cell.row);
    if (order.size() < 4) return;
    std::sort(order.rbegin(), order.rend());
    std::string text = "From the fastest form of OpenMP to the slowest:";
    for (const auto& [speedup, row] : order)
      text += fmt::format("{} {} ({})", row == order.front().second ? "" : ",", row, times_text(speedup));
    add("Loops.", text + ". In the report: rows, rows+reduction, collapse, reduction.", "table2");
  }

  void crowding() {
    const int processors = study_.machine.processors;
    const double own = speedup_at(study_, "table3", all_ + " static", "float");
    const double more = speedup_at(study_, "table3", "12 static", "float");
    const double own_dynamic = speedup_at(study_, "table3", all_ + " dynamic", "float");
    const double more_dynamic = speedup_at(study_, "table3", "12 dynamic", "float");
    if (processors >= 12 || own == 0 || more == 0 || own_dynamic == 0 || more_dynamic == 0) return;
    add("Threads.",
        fmt::format(
            "12 threads on {} processors: static goes from {} to {}, since each thread's part is smaller and the "
            "system divides the processors among them; dynamic from {} to {}.",
            processors, times_text(own), times_text(more), times_text(own_dynamic), times_text(more_dynamic)),
        "table3");
  }

  void gpus() {
    const auto [block, pixel] = fastest_row(study_, "table4", "float");
    const auto [chunks, chunked] = fastest_row(study_, "table5", "float");
    if (pixel > 0 && chunked > 0) {
      std::string text =
          fmt::format("One thread per pixel is fastest in blocks of {} ({} over one core, float), chunks in {} ({}).",
                      block, times_text(pixel), chunks, times_text(chunked));
      const double persistent = speedup_at(study_, "engines", name::cuda_persistent, "float");
      if (persistent > 0)
        text += fmt::format(" Persistent threads that take work from a queue: {}.", times_text(persistent));
      const double optix = speedup_at(study_, "optix", name::optix, "float");
      if (optix > 0) text += fmt::format(" OptiX: {}.", times_text(optix));
      add("GPU.", text);
      return;
    }
    const Table* table = study_.table("table4");
    const Trial* trial = table && !table->cells.empty() ? study_.find(table->cells.front().trial) : nullptr;
    if (trial && !trial->reason.empty()) add("GPU.", "Not measured: " + trial->reason + ".");
  }

  void figure3() {
    if (study_.work_per_thread.is_there()) add("Work per thread.", figure3_text(study_));
  }

  void queries() {
    const double wide = speedup_at(study_, "queries", name::wide_bvh, "float");
    const double binary = speedup_at(study_, "queries", name::binary_bvh, "float");
    if (wide == 0 || binary == 0) return;
    std::string text = fmt::format(
        "On this scene a binary BVH answers rays {} the linear scan over {} objects, the wide one with SIMD {}",
        compared(binary, "as fast as", "slower than"), study_.scene.spheres + study_.scene.triangles, times_text(wide));
    const double embree = speedup_at(study_, "queries", name::embree, "float");
    if (embree > 0) text += fmt::format(", Embree {}", times_text(embree));
    add("Tree.", text + " (float, one thread, shading included).");
  }

  void objects() {
    const Table* table = study_.table("objects");
    if (!table) return;
    std::string growth;
    for (const std::string& column : table->columns) {
      const Trial *few = trial_at(study_, "objects", "10", column),
                  *many = trial_at(study_, "objects", "1000000", column);
      if (!few || !many) continue;
      const double ratio = cost_of(*many, Measure::nanoseconds_per_ray) / cost_of(*few, Measure::nanoseconds_per_ray);
      growth += fmt::format("{} {} times as long with {}", growth.empty() ? "" : ",", short_number(ratio), column);
    }
    const double million = speedup_at(study_, "objects", "1000000", name::wide_bvh);
    if (growth.empty() || million == 0) return;
    add("Objects.", fmt::format("From 10 spheres to a million a ray takes{}: there the BVH is {} the linear scan.",
                                growth, compared(million, "as fast as", "slower than")));
  }

  void depth() {
    const Table* table = study_.table("depth");
    if (!table) return;
    const Trial* branching = trial_at(study_, "depth", "12", table->columns.front());
    const Trial* iterative = trial_at(study_, "depth", "12", table->columns.back());
    if (!branching || !iterative) return;
    const auto rays = [](const Trial& t) { return static_cast<double>(t.rays) / static_cast<double>(t.samples); };
    add("Depth.",
        fmt::format("At D = 12 branching takes {} rays per camera sample and {} times as long as iterative with "
                    "{}. Only paths that hit glass branch, so the growth is below the 2^D of the worst case.",
                    short_number(rays(*branching)),
                    short_number(cost_of(*branching, Measure::seconds) / cost_of(*iterative, Measure::seconds)),
                    short_number(rays(*iterative))));
  }

  void glass() {
    const Trial* branching = trial_at(study_, "glass", "12", name::branching);
    const Trial* before = trial_at(study_, "glass", "11", name::branching);
    const Trial* iterative = trial_at(study_, "glass", "12", name::iterative);
    if (!branching || !before || !iterative) return;
    const auto rays = [](const Trial& t) { return static_cast<double>(t.rays) / static_cast<double>(t.samples); };
    add("Glass.",
        fmt::format(
            "In a cloud of nothing but glass branching takes {} rays per camera sample at D = 12, {:.2f} times as many "
            "as at D = 11, and {} times as long as iterative with {} rays.",
            short_number(rays(*branching)), rays(*branching) / rays(*before),
            short_number(cost_of(*branching, Measure::seconds) / cost_of(*iterative, Measure::seconds)),
            short_number(rays(*iterative))));
  }

  /// The time that `path` takes to reach the error that `iterative` has with most samples, interpolated linearly
  /// between two measured points in logarithmic axes.
  void error() {
    const Table* table = study_.table("error");
    if (!table || table->rows().empty()) return;
    const Trial* slow = trial_at(study_, "error", table->rows().back(), "iterative");
    if (!slow || slow->rmse <= 0) return;
    const double time = spread_of(slow->seconds).median;
    const Trial* before = nullptr;
    for (const std::string& row : table->rows()) {
      const Trial* trial = trial_at(study_, "error", row, "path");
      if (!trial || trial->rmse <= 0) return;
      if (trial->rmse > slow->rmse) {
        before = trial;
        continue;
      }
      const double after_time = spread_of(trial->seconds).median;
      const std::string start = fmt::format("The error that iterative has after {} (RMSE {}, S = {}) path ",
                                            seconds_text(time), short_number(slow->rmse), slow->samples_per_pixel);
      if (!before) {
        add("Equal error.",
            fmt::format("{}is below already at S = {}, after {}: at least {} times as fast.", start,
                        trial->samples_per_pixel, seconds_text(after_time), short_number(time / after_time)),
            "error");
        return;
      }
      const double at = std::log(before->rmse / slow->rmse) / std::log(before->rmse / trial->rmse);
      const double before_time = spread_of(before->seconds).median;
      const double wanted = before_time * std::pow(after_time / before_time, at);
      add("Equal error.",
          fmt::format("{}reaches in {}: {} times as fast (interpolated between S = {} and {}).", start,
                      seconds_text(wanted), short_number(time / wanted), before->samples_per_pixel,
                      trial->samples_per_pixel),
          "error");
      return;
    }
  }

  const Study& study_;
  std::string all_;
  std::vector<Conclusion> list_;
};

}  // namespace

namespace {

struct Disturbance {
  size_t made_again = 0, kept = 0, runs = 0;
};

Disturbance disturbance_of(const Study& study) {
  Disturbance d;
  for (const Trial& trial : study.trials) {
    d.made_again += trial.disturbed_seconds.size();
    d.runs += trial.seconds.size();
    for (const double fraction : trial.processor_fractions) d.kept += fraction < min_processor_fraction;
  }
  return d;
}

std::string text_of(const Disturbance& d) {
  if (d.made_again + d.kept == 0) return "no run had less than nine tenths of the processors that it could use";
  return fmt::format("runs that other programs disturbed: {} repeated, {} among the figures and marked", d.made_again,
                     d.kept);
}

/// "OpenMP rows, 12 threads, static" for a row of Table 3.
std::string name_of_row(const std::string& table, const std::string& prefix, const std::string& row) {
  if (table != "table3") return prefix + row;
  const size_t space = row.find(' ');
  return prefix + row.substr(0, space) + " threads," + row.substr(space);
}

}  // namespace

Headline headline_of(const Study& study) {
  Headline headline;
  const std::pair<const char*, const char*> tables[] = {{"table2", "OpenMP "},
                                                        {"table3", "OpenMP rows, "},
                                                        {"table4", "CUDA blocks "},
                                                        {"table5", "CUDA chunks "},
                                                        {"optix", ""},
                                                        {"engines", ""}};
  for (const auto& [id, prefix] : tables) {
    const auto [row, speedup] = fastest_row(study, id, "float");
    if (speedup > headline.speedup) headline = {"", name_of_row(id, prefix, row), speedup};
  }
  headline.text = headline.engine.empty()
                      ? std::string("Accelerating ray tracing: a study")
                      : fmt::format("{}: {} times one core", headline.engine, short_number(headline.speedup));
  return headline;
}

std::vector<Conclusion> conclusions_of(const Study& study) { return Conclusions(study).take(); }

std::string figure3_text(const Study& study) {
  const WorkPerThread& w = study.work_per_thread;
  return fmt::format(
      "With one thread per pixel the threads' paths have from {:.2f} to {:.2f} segments on average (mean {:.2f}); with "
      "{} "
      "x {} "
      "chunks from {:.2f} to {:.2f}, of the same total. The largest falls by a factor of {:.2f}; in the report by "
      "about "
      "2.5, from 9 or 10 to 4.",
      w.naive.smallest_mean(), w.naive.largest_mean(), w.naive.mean(), w.chunks_x, w.chunks_y,
      w.chunked.smallest_mean(), w.chunked.largest_mean(), w.naive.largest_mean() / w.chunked.largest_mean());
}

double usual_noise(const Study& study) {
  std::vector<double> noises;
  for (const Trial& trial : study.trials) {
    if (!trial.has_times() || trial.seconds.size() < 2) continue;
    const Spread spread = spread_of(trial.seconds);
    noises.push_back((spread.max - spread.min) / 2 / spread.median);
  }
  return noises.empty() ? 0 : spread_of(noises).median;
}

std::string disturbance_warning(const Study& study) {
  const Disturbance d = disturbance_of(study);
  if (d.kept * 20 < d.runs || d.runs == 0) return {};
  return fmt::format(
      "in {} of {} runs other programs used processors of this machine: the marked times are too long, and so "
      "are speedups computed from them; the same command with --resume repeats those runs",
      d.kept, d.runs);
}

std::string image_sizes_of(const Study& study, const Table& table) {
  std::vector<std::string> sizes;
  for (const Cell& cell : table.cells) {
    const Trial* t = study.find(cell.trial);
    if (!t || !t->has_times()) continue;
    const std::string size = fmt::format("{} x {} pixels, S = {}", t->width, t->height, t->samples_per_pixel);
    if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) sizes.push_back(size);
  }
  return sizes.empty() || sizes.size() > 2 ? "" : fmt::format("{}.", fmt::join(sizes, "; or "));
}

std::vector<std::string> facts_of(const Study& study) {
  const Machine& m = study.machine;
  const SceneFacts& s = study.scene;
  double min_load = 0, max_load = 0;
  for (const Conditions& c : study.conditions) {
    min_load = &c == &study.conditions.front() ? c.load : std::min(min_load, c.load);
    max_load = std::max(max_load, c.load);
  }
  std::vector<std::string> lines{
      fmt::format("{}, {} processors, {}, {:.0f} GiB; {}", m.processor, m.processors, m.instructions, m.memory_gib,
                  m.system),
      fmt::format("Alhazen {}, {}, {}", m.version, m.compiler, m.flags),
      fmt::format("{} (hash {}): {} spheres, {} triangles; lights: {}; D = {}", s.name, s.hash, s.spheres, s.triangles,
                  s.lights, s.segments),
      fmt::format(
          "{}: level {}; CPU {} x {} pixels, S = {}; GPU {} x {}, S = {}; {} repeats in turn, {:.0f} s in all{}",
          study.date, study.scale.name, study.scale.width ? study.scale.width : s.width,
          study.scale.height ? study.scale.height : s.height, study.scale.samples, s.width, s.height,
          study.scale.gpu_samples, study.scale.repeats, study.seconds,
          study.is_complete ? "" : "; interrupted: missing cells are marked")};
  if (const double noise = usual_noise(study); noise > 0)
    lines.push_back(fmt::format(
        "Half the spread of a usual cell over its repeats is {:.1f} % of its median; load average {:.1f} to "
        "{:.1f}, {:.0f} MHz; {}",
        100 * noise, min_load, max_load, study.conditions.empty() ? 0 : study.conditions.back().megahertz,
        text_of(disturbance_of(study))));
  return lines;
}

}  // namespace alhazen::study
