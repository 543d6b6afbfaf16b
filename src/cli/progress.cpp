#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "util/diagnostics.h"

namespace alhazen {

namespace {

double samples_per_second(const Progress& p) {
  return p.seconds > 0 ? static_cast<double>(p.samples_done) / p.seconds : 0;
}

double seconds_left(const Progress& p) { return p.fraction > 0 ? p.seconds / p.fraction * (1 - p.fraction) : 0; }

/// The bar must not wrap, so that it can be overwritten.
constexpr int bar_width = 30;

}  // namespace

ProgressStyle parse_progress_style(const std::string& name) {
  if (name == "auto") return isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::lines;
  if (name == "plain") return ProgressStyle::lines;
  if (name == "json") return ProgressStyle::json;
  if (name == "none") return ProgressStyle::none;
  throw InputError("unknown progress '" + name + "': it may be auto, plain, json, none");
}

std::string format_seconds(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

void ProgressPrinter::show(const Progress& progress) {
  const std::lock_guard lock(mutex_);
  switch (style_) {
    case ProgressStyle::bar:
      return show_bar(progress);
    case ProgressStyle::lines:
      return show_line(progress);
    case ProgressStyle::json:
      return show_json(progress);
    case ProgressStyle::none:
      return;
  }
}

void ProgressPrinter::finish() {
  const std::lock_guard lock(mutex_);
  end_bar();
}

void ProgressPrinter::tell_lines(const std::string& lines) {
  const std::lock_guard lock(mutex_);
  end_bar();
  tell_text(lines);
}

void ProgressPrinter::end_bar() {
  if (bar_open_) tell_text("\n");
  bar_open_ = false;
}

void ProgressPrinter::show_bar(const Progress& p) {
  const int filled = std::clamp(static_cast<int>(p.fraction * bar_width), 0, bar_width);
  tell_progress(fmt::format("\r[{}{}] {:3.0f}%  {:.2f} Msamples/s  {} left\x1b[K",
                            std::string(static_cast<size_t>(filled), '#'),
                            std::string(static_cast<size_t>(bar_width - filled), '.'), p.fraction * 100,
                            samples_per_second(p) * 1e-6, format_seconds(seconds_left(p))));
  bar_open_ = true;
}

/// Lines become less frequent as the render proceeds, so that a long one does not fill a log.
void ProgressPrinter::show_line(const Progress& p) {
  if (p.seconds < last_shown_ + interval_ && !(p.fraction >= 1 && last_shown_ >= 0)) return;
  if (p.seconds < 1 && p.fraction < 1) return;
  tell_progress(fmt::format("{:3.0f}%  {:.2f} Msamples/s  {} left\n", p.fraction * 100, samples_per_second(p) * 1e-6,
                            format_seconds(seconds_left(p))));
  last_shown_ = p.fraction >= 1 ? 1e300 : p.seconds;
  interval_ = std::min(interval_ * 1.5, 60.0);
}

void ProgressPrinter::show_json(const Progress& p) {
  if (p.seconds < last_shown_ + 0.5 && p.fraction < 1) return;
  const nlohmann::ordered_json j{{"fraction", p.fraction},           {"seconds", p.seconds},
                                 {"seconds_left", seconds_left(p)},  {"samples_done", p.samples_done},
                                 {"samples_total", p.samples_total}, {"samples_per_second", samples_per_second(p)}};
  tell_progress(j.dump() + "\n");
  last_shown_ = p.seconds;
}

}  // namespace alhazen
