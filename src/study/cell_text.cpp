#include "study/cell_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/disturbance.h"

namespace alhazen::impl::study {

std::string short_number(double value) {
  const double size = std::abs(value);
  if (size >= 100 || size == 0) return fmt::format("{:.0f}", value);
  if (size >= 10) return fmt::format("{:.1f}", value);
  if (size >= 1) return fmt::format("{:.2f}", value);
  const int digits = std::min(9, 2 - static_cast<int>(std::floor(std::log10(size))));
  return fmt::format("{:.{}f}", value, digits);
}

std::string seconds_text(double seconds) { return short_number(seconds) + " s"; }

std::string times_text(double factor) { return short_number(factor) + "x"; }

namespace {

std::string report_text(const Cell& cell) {
  std::string text;
  for (const ReportFigure& figure : cell.report) {
    if (!text.empty()) text += ", ";
    text += figure.machine + " ";
    text += figure.seconds > 0 ? fmt::format("{:.0f} s", figure.seconds) : "N/A";
    if (figure.speedup > 0) text += fmt::format(" ({:.2f}x)", figure.speedup);
  }
  return text;
}

double rays_per_sample(const Trial& trial) {
  return static_cast<double>(trial.rays + trial.shadow_rays) / static_cast<double>(trial.samples);
}

void set_value(const Table& table, const Trial& trial, CellText& text) {
  const Spread spread = spread_of(trial.seconds);
  const double units = static_cast<double>(trial.rays + trial.shadow_rays) * 1e-9;
  switch (table.measure) {
    case Measure::seconds:
      text.value = seconds_text(spread.median);
      text.spread = short_number(spread.min) + " to " + short_number(spread.max);
      if (table.shows_rays) text.spread += fmt::format("; {} rays", short_number(rays_per_sample(trial)));
      return;
    case Measure::nanoseconds_per_ray:
      text.value = short_number(spread.median / units) + " ns";
      text.spread = short_number(spread.min / units) + " to " + short_number(spread.max / units);
      return;
    case Measure::load_balance:
      text.value = fmt::format("{:.3f}", busiest_over_mean(trial));
      text.spread = fmt::format("Gini {:.3f}; {}", gini_of_busy(trial), seconds_text(spread.median));
      return;
    case Measure::error:
      text.value = trial.rmse >= 0 ? short_number(trial.rmse) : std::string("no reference");
      text.spread = "in " + seconds_text(spread.median);
      return;
  }
}

}  // namespace

CellText text_of(const Study& study, const Table& table, const Cell& cell) {
  const Trial& trial = *study.find(cell.trial);
  CellText text;
  text.report = report_text(cell);
  text.note = cell.note;
  text.is_measured = trial.has_times();
  if (!text.is_measured) {
    text.value = trial.status == TrialStatus::not_run ? "not run" : "N/A";
    text.note = trial.reason + (trial.reason.empty() || cell.note.empty() ? "" : "; ") + cell.note;
    return text;
  }
  set_value(table, trial, text);
  const auto add_note = [&](const std::string& note) { text.note += (text.note.empty() ? "" : "; ") + note; };
  text.doubt = doubt_of(study, cell);
  if (!text.doubt.empty()) add_note("in doubt: " + text.doubt);
  if (const double speedup = speedup_of(study, table, cell); speedup > 0) text.speedup = times_text(speedup);
  return text;
}

size_t Footnotes::number_of(const std::string& note) {
  if (note.empty()) return 0;
  const auto at = std::find(notes_.begin(), notes_.end(), note);
  if (at != notes_.end()) return static_cast<size_t>(at - notes_.begin()) + 1;
  notes_.push_back(note);
  return notes_.size();
}

}  // namespace alhazen::impl::study
