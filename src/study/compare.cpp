#include "study/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "util/diagnostics.h"

namespace alhazen::impl::study {

namespace {

using StudyJson = nlohmann::json;

struct Measured {
  std::string table, row, column, status, reason;
  StudyJson cell;
  bool by_ray = false;
};

/// Cells by table, row and column.
std::map<std::string, Measured> cells_of(const StudyJson& study) {
  std::map<std::string, Measured> cells;
  for (const StudyJson& table : study.at("tables"))
    for (const StudyJson& cell : table.at("cells")) {
      Measured m{table.at("id"),
                 cell.at("row"),
                 cell.at("column"),
                 cell.at("status"),
                 cell.value("reason", ""),
                 cell,
                 table.at("measure") == "nanoseconds per ray"};
      // Without seconds there is no measurement, whatever the status says.
      if (m.status == "ok" && !cell.contains("seconds")) m.status = "not run";
      cells.emplace(m.table + "\n" + m.row + "\n" + m.column, std::move(m));
    }
  return cells;
}

void note_differences(const StudyJson& a, const StudyJson& b, StudyComparison& comparison) {
  const std::pair<const char*, const char*> facts[] = {{"/version", "version"},
                                                       {"/machine/processor", "processor"},
                                                       {"/machine/processors", "number of processors"},
                                                       {"/build/compiler", "compiler"},
                                                       {"/build/flags", "flags"},
                                                       {"/scene/hash", "scene"},
                                                       {"/scale/name", "level"},
                                                       {"/complete", "complete"}};
  for (const auto& [pointer, name] : facts) {
    const StudyJson& in_a = a.at(StudyJson::json_pointer(pointer));
    const StudyJson& in_b = b.at(StudyJson::json_pointer(pointer));
    if (in_a != in_b) comparison.differences.push_back(fmt::format("{}: {} and {}", name, in_a.dump(), in_b.dump()));
  }
}

/// Factor from seconds to nanoseconds per sample, or per ray.
double unit_of(const Measured& m) {
  return m.cell.at(m.by_ray ? "nanoseconds_per_ray" : "nanoseconds_per_sample").get<double>() /
         m.cell.at("seconds").at("median").get<double>();
}

bool is_beyond_noise(const Measured& a, const Measured& b, double threshold) {
  const double unit_a = unit_of(a), unit_b = unit_of(b);
  const StudyJson &in_a = a.cell.at("seconds"), &in_b = b.cell.at("seconds");
  const double min_a = in_a.at("min").get<double>() * unit_a, max_a = in_a.at("max").get<double>() * unit_a;
  const double min_b = in_b.at("min").get<double>() * unit_b, max_b = in_b.at("max").get<double>() * unit_b;
  const double ratio = in_b.at("median").get<double>() * unit_b / (in_a.at("median").get<double>() * unit_a);
  return (min_b > max_a || max_b < min_a) && std::abs(std::log(ratio)) > std::log1p(threshold);
}

/// Probability that all repeats of one are above all of the other by chance: two orders of all permutations.
double probability_by_chance(const Measured& a, const Measured& b) {
  const double n = static_cast<double>(a.cell.at("seconds").at("samples").size());
  const double m = static_cast<double>(b.cell.at("seconds").at("samples").size());
  return 2 * std::exp(std::lgamma(n + 1) + std::lgamma(m + 1) - std::lgamma(n + m + 1));
}

/// Why the times of two cells cannot be compared; empty if they can.
std::string doubt_of(const Measured& a, const Measured& b) {
  std::string doubt;
  for (const auto& [cell, name] : {std::pair{&a, "the first"}, {&b, "the second"}})
    if (const std::string text = cell->cell.value("doubt", ""); !text.empty())
      doubt += fmt::format("{}{}: {}", doubt.empty() ? "" : "; ", name, text);
  return doubt;
}

void compare_cells(const StudyJson& a, const StudyJson& b, double threshold, StudyComparison& comparison) {
  const std::map<std::string, Measured> in_a = cells_of(a), in_b = cells_of(b);
  double probabilities = 0;
  for (const auto& [key, cell_a] : in_a) {
    const auto at = in_b.find(key);
    const std::string name = fmt::format("{}, {}, {}", cell_a.table, cell_a.row, cell_a.column);
    if (at == in_b.end()) {
      comparison.states.push_back(name + ": in the first alone");
      continue;
    }
    const Measured& cell_b = at->second;
    if (cell_a.status != cell_b.status) {
      const auto state = [](const Measured& m) { return m.status + (m.reason.empty() ? "" : " (" + m.reason + ")"); };
      comparison.states.push_back(fmt::format("{}: {}, then {}", name, state(cell_a), state(cell_b)));
    }
    if (cell_a.status != "ok" || cell_b.status != "ok") continue;
    ++comparison.compared;
    probabilities += probability_by_chance(cell_a, cell_b);
    if (!is_beyond_noise(cell_a, cell_b, threshold)) continue;
    const auto median = [](const Measured& m) { return m.cell.at("seconds").at("median").get<double>() * unit_of(m); };
    comparison.changes.push_back({cell_a.table, cell_a.row, cell_a.column, median(cell_a), median(cell_b),
                                  cell_a.cell.value("speedup", 0.0), cell_b.cell.value("speedup", 0.0),
                                  doubt_of(cell_a, cell_b)});
  }
  for (const auto& [key, cell_b] : in_b)
    if (!in_a.contains(key))
      comparison.states.push_back(
          fmt::format("{}, {}, {}: in the second alone", cell_b.table, cell_b.row, cell_b.column));
  comparison.by_chance = static_cast<size_t>(std::ceil(probabilities));
}

}  // namespace

StudyComparison compare_studies(const StudyJson& a, const StudyJson& b, double threshold, const std::string& path_a,
                                const std::string& path_b) try {
  StudyComparison comparison;
  note_differences(a, b, comparison);
  compare_cells(a, b, threshold, comparison);
  std::sort(comparison.changes.begin(), comparison.changes.end(), [](const Change& x, const Change& y) {
    return std::abs(std::log(x.ratio())) > std::abs(std::log(y.ratio()));
  });
  return comparison;
} catch (const StudyJson::exception& error) {
  throw InputError(fmt::format("{} or {} is damaged: {}", path_a, path_b, error.what()));
}

}  // namespace alhazen::impl::study
