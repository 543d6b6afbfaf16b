#include "study/conclusions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/cell_text.h"
#include "study/disturbance.h"
#include "study/names.h"
#include "study/report_figures.h"

namespace alhazen::impl::study {

namespace {

/// The fastest row of a table in a column, of those that are not in doubt, and its speedup.
std::pair<std::string, double> fastest_row(const Study& study, const std::string& table_id, const std::string& column) {
  std::pair<std::string, double> best;
  const Table* table = study.table(table_id);
  if (!table) return best;
  for (const Cell& cell : table->cells) {
    const double speedup = cell.column == column ? trusted_speedup_of(study, *table, cell) : 0;
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
    for (const auto conclude :
         {&Conclusions::precision, &Conclusions::schedule, &Conclusions::forms, &Conclusions::crowding,
          &Conclusions::batches, &Conclusions::gpus, &Conclusions::figure3, &Conclusions::queries,
          &Conclusions::objects, &Conclusions::depth, &Conclusions::glass, &Conclusions::error}) {
      doubts_.clear();
      (this->*conclude)();
    }
    return std::move(list_);
  }

 private:
  /// Adds a conclusion, or why it is withheld: what it is drawn from must not be in doubt.
  void add(const std::string& title, const std::string& text) {
    if (doubts_.empty()) return list_.push_back({title, text, false});
    std::string reason = doubts_.front();
    if (doubts_.size() > 1) reason += fmt::format("; and {} more", doubts_.size() - 1);
    withhold(title, reason + ". The same command with --resume measures such runs again");
  }

  void withhold(const std::string& title, const std::string& reason) {
    list_.push_back({title, "Withheld: " + reason + ".", true});
  }

  /// Notes that the next conclusion is drawn from a cell.
  void use(const Table& table, const Cell& cell) {
    const std::string doubt = doubt_of(study_, cell);
    if (doubt.empty()) return;
    const std::string text = fmt::format("{}, {}, {}: {}", table.id, cell.row, cell.column, doubt);
    if (std::find(doubts_.begin(), doubts_.end(), text) == doubts_.end()) doubts_.push_back(text);
  }

  const Cell* cell_at(const Table* table, const std::string& row, const std::string& column) {
    const Cell* cell = table ? table->find(row, column) : nullptr;
    if (cell) use(*table, *cell);
    return cell;
  }

  /// The measured trial of a cell, or null.
  const Trial* trial_at(const std::string& table_id, const std::string& row, const std::string& column) {
    const Cell* cell = cell_at(study_.table(table_id), row, column);
    const Trial* trial = cell ? study_.find(cell->trial) : nullptr;
    return trial && trial->has_times() ? trial : nullptr;
  }

  double speedup_at(const std::string& table_id, const std::string& row, const std::string& column) {
    const Table* table = study_.table(table_id);
    const Cell* cell = cell_at(table, row, column);
    return cell ? speedup_of(study_, *table, *cell) : 0;
  }

  void precision() {
    const Trial* in_float = trial_at("table1", name::iterative, "float");
    const Trial* in_double = trial_at("table1", name::iterative, "double");
    if (!in_float || !in_double) return;
    const double ratio = cost_of(*in_double, Measure::seconds) / cost_of(*in_float, Measure::seconds);
    std::string text = fmt::format("On one core double takes {:.2f} times as long as float.", ratio);
    if (!are_separated(*in_float, *in_double, Measure::seconds))
      text = fmt::format("On one core double and float differ no more than their repeats do ({:.2f} times).", ratio);
    const std::vector<ReportFigure> floats = report_figures("table1", name::recursive, "float"),
                                    doubles = report_figures("table1", name::recursive, "double");
    for (size_t i = 0; i < floats.size() && i < doubles.size(); ++i)
      text += fmt::format("{}{:.2f} times as long on {}", i == 0 ? " In the report it took " : " and ",
                          doubles[i].seconds / floats[i].seconds, floats[i].machine);
    add("Precision.", text + (floats.empty() ? "" : "."));
  }

  void schedule() {
    const std::string static_row = all_ + " static", dynamic_row = all_ + " dynamic";
    const double fixed = speedup_at("table3", static_row, "float"),
                 dynamic = speedup_at("table3", dynamic_row, "float");
    const Trial *in_static = trial_at("table3", static_row, "float"),
                *in_dynamic = trial_at("table3", dynamic_row, "float");
    if (fixed == 0 || dynamic == 0 || !in_static || !in_dynamic) return;
    const double ratio = dynamic / fixed;
    // Both schedules do the same work, so all that a schedule changes is how evenly threads share it.
    const double of_static = busiest_over_mean(*in_static), of_dynamic = busiest_over_mean(*in_dynamic);
    const double explained = of_static / of_dynamic;
    if (doubts_.empty() && std::abs(std::log(ratio / explained)) > std::log1p(max_unexplained))
      return withhold("Schedule.",
                      fmt::format("on {} threads a dynamic schedule of rows measured {:.2f} times as fast as a static "
                                  "one, but how evenly the threads were busy explains a factor of {:.2f} alone. "
                                  "Something else slowed some of these runs",
                                  all_, ratio, explained));
    std::string text =
        are_separated(*in_static, *in_dynamic, Measure::seconds)
            ? fmt::format("On {} threads a dynamic schedule of rows is {} a static one: {} against {} over one core.",
                          all_, compared(ratio, "as fast as", "slower than"), times_text(dynamic), times_text(fixed))
            : fmt::format(
                  "On {} threads a dynamic and a static schedule of rows differ no more than their repeats "
                  "do: {} and {} over one core.",
                  all_, times_text(dynamic), times_text(fixed));
    text += fmt::format(
        " Why: with the static one the busiest thread works {:.2f} times the mean, with the dynamic one {:.2f} times.",
        of_static, of_dynamic);
    add("Schedule.", text);
  }

  void forms() {
    const Table* table = study_.table("table2");
    if (!table) return;
    std::vector<std::pair<double, const Cell*>> order;
    for (const Cell& cell : table->cells) {
      use(*table, cell);
      if (const double speedup = speedup_of(study_, *table, cell); speedup > 0) order.emplace_back(speedup, &cell);
    }
    if (order.size() < 4) return;
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text = "From the fastest form of OpenMP to the slowest, all a path at a time:", equal;
    for (size_t i = 0; i < order.size(); ++i) {
      text += fmt::format("{} {} ({})", i == 0 ? "" : ",", order[i].second->row, times_text(order[i].first));
      if (i > 0 && !are_separated(*study_.find(order[i - 1].second->trial), *study_.find(order[i].second->trial),
                                  Measure::seconds))
        equal += fmt::format(" {} and {} differ no more than their repeats do.", order[i - 1].second->row,
                             order[i].second->row);
    }
    add("Loops.", text + "." + equal + " In the report: rows (3.45x), rows+reduction, collapse, reduction (2.25x).");
  }

  void batches() {
    const Table* table = study_.table("batches");
    if (!table) return;
    std::string text;
    for (const std::string& row : table->rows()) {
      const double speedup = speedup_at("batches", row, name::batches);
      if (speedup > 0) text += fmt::format("{} {} {}", text.empty() ? "" : ",", row, times_text(speedup));
    }
    if (!text.empty())
      add("Batches.", "Over a path at a time, batches make the same form faster or slower by:" + text + ".");
  }

  void crowding() {
    const int processors = study_.machine.processors;
    const double own = speedup_at("table3", all_ + " static", "float");
    const double more = speedup_at("table3", "12 static", "float");
    const double own_dynamic = speedup_at("table3", all_ + " dynamic", "float");
    const double more_dynamic = speedup_at("table3", "12 dynamic", "float");
    if (processors >= 12 || own == 0 || more == 0 || own_dynamic == 0 || more_dynamic == 0) return;
    add("Threads.",
        fmt::format(
            "12 threads on {} processors: static goes from {} to {}, since each thread's part is smaller and the "
            "system divides the processors among them; dynamic from {} to {}.",
            processors, times_text(own), times_text(more), times_text(own_dynamic), times_text(more_dynamic)));
  }

  void gpus() {
    const auto [block, pixel] = fastest_row(study_, "table4", "float");
    const auto [chunks, chunked] = fastest_row(study_, "table5", "float");
    if (pixel > 0 && chunked > 0) {
      trial_at("table4", block, "float");
      trial_at("table5", chunks, "float");
      std::string text =
          fmt::format("One thread per pixel is fastest in blocks of {} ({} over one core, float), chunks in {} ({}).",
                      block, times_text(pixel), chunks, times_text(chunked));
      const double persistent = speedup_at("engines", name::cuda_persistent, "float");
      if (persistent > 0)
        text += fmt::format(" Persistent threads that take work from a queue: {}.", times_text(persistent));
      const double optix = speedup_at("optix", name::optix, "float");
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
    const double wide = speedup_at("queries", name::wide_bvh, "float");
    const double binary = speedup_at("queries", name::binary_bvh, "float");
    if (wide == 0 || binary == 0) return;
    std::string text = fmt::format(
        "On this scene a binary BVH answers rays {} the linear scan over {} objects, the wide one with SIMD {}",
        compared(binary, "as fast as", "slower than"), study_.scene.spheres + study_.scene.triangles, times_text(wide));
    const double embree = speedup_at("queries", name::embree, "float");
    if (embree > 0) text += fmt::format(", Embree {}", times_text(embree));
    add("Tree.", text + " (float, one thread, shading included).");
  }

  void objects() {
    const Table* table = study_.table("objects");
    if (!table) return;
    std::string growth;
    for (const std::string& column : table->columns) {
      const Trial *few = trial_at("objects", "10", column), *many = trial_at("objects", "1000000", column);
      if (!few || !many) continue;
      const double ratio = cost_of(*many, Measure::nanoseconds_per_ray) / cost_of(*few, Measure::nanoseconds_per_ray);
      growth += fmt::format("{} {} times as long with {}", growth.empty() ? "" : ",", short_number(ratio), column);
    }
    const double million = speedup_at("objects", "1000000", name::wide_bvh);
    if (growth.empty() || million == 0) return;
    add("Objects.", fmt::format("From 10 spheres to a million a ray takes{}: there the BVH is {} the linear scan.",
                                growth, compared(million, "as fast as", "slower than")));
  }

  void depth() {
    const Table* table = study_.table("depth");
    if (!table) return;
    const Trial* branching = trial_at("depth", "12", table->columns.front());
    const Trial* iterative = trial_at("depth", "12", table->columns.back());
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
    const Trial* branching = trial_at("glass", "12", name::branching);
    const Trial* before = trial_at("glass", "11", name::branching);
    const Trial* iterative = trial_at("glass", "12", name::iterative);
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
    const Trial* slow = trial_at("error", table->rows().back(), "iterative");
    if (!slow || slow->rmse <= 0) return;
    const double time = spread_of(slow->seconds).median;
    const Trial* before = nullptr;
    for (const std::string& row : table->rows()) {
      const Trial* trial = trial_at("error", row, "path");
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
                        trial->samples_per_pixel, seconds_text(after_time), short_number(time / after_time)));
        return;
      }
      const double at = std::log(before->rmse / slow->rmse) / std::log(before->rmse / trial->rmse);
      const double before_time = spread_of(before->seconds).median;
      const double wanted = before_time * std::pow(after_time / before_time, at);
      add("Equal error.", fmt::format("{}reaches in {}: {} times as fast (interpolated between S = {} and {}).", start,
                                      seconds_text(wanted), short_number(time / wanted), before->samples_per_pixel,
                                      trial->samples_per_pixel));
      return;
    }
  }

  /// Relative difference of a ratio of times and what explains it, from which on it is not explained.
  static constexpr double max_unexplained = 0.15;

  const Study& study_;
  std::string all_;
  std::vector<std::string> doubts_;  ///< about what the next conclusion is drawn from
  std::vector<Conclusion> list_;
};

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

}  // namespace alhazen::impl::study
