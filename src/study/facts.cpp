// What is told about a study as a whole: where, when and how it was measured, and what makes it less reliable.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "study/conclusions.h"
#include "study/disturbance.h"
#include "study/report_figures.h"

namespace alhazen::impl::study {

namespace {

std::string replaced_runs(const Study& study) {
  size_t replaced = 0, kept = 0;
  for (const Trial& trial : study.trials) {
    replaced += trial.disturbed_seconds.size();
    kept += disturbed_runs(trial);
  }
  if (replaced + kept == 0) return "no run was disturbed by other programs";
  return fmt::format(
      "runs that were disturbed or much slower than their repeats: {} replaced, {} among the figures "
      "and marked",
      replaced, kept);
}

bool has_times(const Study& study, const Table& table) {
  return std::any_of(table.cells.begin(), table.cells.end(),
                     [&](const Cell& cell) { return study.find(cell.trial)->has_times(); });
}

}  // namespace

std::string reproduced_text(const Study& study) {
  std::vector<std::string> here, missing;
  const std::pair<const char*, const char*> tables[] = {
      {"table1", "Table 1 (one core)"},     {"table2", "Table 2 (forms of OpenMP)"}, {"table3", "Table 3 (threads)"},
      {"table4", "Table 4 (CUDA, blocks)"}, {"table5", "Table 5 (CUDA, chunks)"},    {"optix", "OptiX"}};
  for (const auto& [id, name] : tables) {
    const Table* table = study.table(id);
    (table && has_times(study, *table) ? here : missing).emplace_back(name);
  }
  (study.work_per_thread.is_there() ? here : missing).emplace_back("Figure 3 (work per thread)");
  std::string text = fmt::format("This study reproduces \"{}\" by {}.", report_title, report_authors);
  if (!here.empty()) text += fmt::format(" Measured here, on this machine and scene: {}.", fmt::join(here, ", "));
  if (!missing.empty()) text += fmt::format(" Not measured here: {}.", fmt::join(missing, ", "));
  return text + " The report's own figures stand beside the measured ones; what has no such column is beyond it.";
}

std::vector<std::string> warnings_of(const Study& study) {
  std::vector<std::string> warnings;
  if (!study.is_complete)
    warnings.push_back(
        fmt::format("this study is incomplete, {} of {} runs are measured: the same command continues it",
                    study.runs_measured(), study.runs_planned()));
  size_t measured = 0, doubtful = 0;
  for (const Trial& trial : study.trials) {
    if (!trial.has_times()) continue;
    ++measured;
    const bool is_short_of_runs = trial.seconds.size() < static_cast<size_t>(study.scale.repeats);
    doubtful += !is_short_of_runs && !doubt_of(trial, study.scale.repeats).empty();
  }
  if (doubtful > 0)
    warnings.push_back(fmt::format(
        "the times of {} of {} works are not those of the machine alone, since other programs used its processors or "
        "repeats differ: their cells are marked, and conclusions that need them are withheld; on a quiet machine, the "
        "same command with --resume measures these runs again",
        doubtful, measured));
  return warnings;
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

std::string image_sizes_of(const Study& study, const Table& table) {
  std::vector<std::string> sizes;
  for (const Cell& cell : table.cells) {
    const Trial* t = study.find(cell.trial);
    if (!t || !t->has_times()) continue;
    const std::string size =
        fmt::format("{} x {} pixels, S = {} samples per pixel", t->width, t->height, t->samples_per_pixel);
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
      fmt::format("{} (hash {}): {} spheres, {} triangles; lights: {}; paths of at most D = {} segments", s.name,
                  s.hash, s.spheres, s.triangles, s.lights, s.segments),
      fmt::format("{}: level {}; CPU {} x {} pixels, S = {} samples per pixel; GPU {} x {}, S = {}; {} repeats in "
                  "turn, {:.0f} s "
                  "in all{}",
                  study.date, study.scale.name, study.scale.width ? study.scale.width : s.width,
                  study.scale.height ? study.scale.height : s.height, study.scale.samples, s.width, s.height,
                  study.scale.gpu_samples, study.scale.repeats, study.seconds,
                  study.is_complete ? "" : "; incomplete: missing cells are marked")};
  if (const double noise = usual_noise(study); noise > 0)
    lines.push_back(fmt::format(
        "Half the spread of a usual cell over its repeats is {:.1f} % of its median; load average {:.1f} to "
        "{:.1f}, {:.0f} MHz; {}",
        100 * noise, min_load, max_load, study.conditions.empty() ? 0 : study.conditions.back().megahertz,
        replaced_runs(study)));
  return lines;
}

}  // namespace alhazen::impl::study
