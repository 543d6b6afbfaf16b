#include "cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "cli/console.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// Of this run, without what a checkpoint held.
double samples_taken(const Progress& p) {
  return static_cast<double>(p.samples_done - std::min(p.samples_loaded, p.samples_done));
}

double samples_per_second(const Progress& p) { return p.seconds > 0 ? samples_taken(p) / p.seconds : 0; }

/// 0 until samples were taken.
double seconds_left(const Progress& p) {
  const double rate = samples_per_second(p);
  return rate > 0 ? static_cast<double>(p.samples_total - p.samples_done) / rate : 0;
}

/// The parts of a line, the most important first, until no more fits. A line that wraps cannot be overwritten.
std::string joined(const std::vector<std::string>& parts, size_t width) {
  std::string line;
  for (const std::string& part : parts) {
    const size_t gap = line.empty() ? 0 : 2;
    if (line.size() + gap + part.size() > width) break;
    line += std::string(gap, ' ') + part;
  }
  return line;
}

/// What is said of progress beside the fraction.
std::vector<std::string> details_of(const Progress& p) {
  std::vector<std::string> parts{fmt::format("{:.0f}%", std::floor(p.fraction * 100)), format_seconds(p.seconds)};
  if (p.fraction < 1) parts.push_back(seconds_left(p) > 0 ? format_seconds(seconds_left(p)) + " left" : "first pass");
  if (p.pixels > 0)
    parts.push_back(fmt::format("{:.0f} spp", static_cast<double>(p.samples_done) / static_cast<double>(p.pixels)));
  if (p.noise > 0) parts.push_back(fmt::format("noise {:.3g}", p.noise));
  parts.push_back(fmt::format("{:.2f} Msamples/s", samples_per_second(p) * 1e-6));
  return parts;
}

size_t terminal_width() { return static_cast<size_t>(terminal_size().columns); }

constexpr size_t longest_bar = 30;

constexpr std::chrono::milliseconds first_word{150}, between_words{100};

}  // namespace

TerminalSize terminal_size() {
  winsize size{};
  TerminalSize known{80, 24};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0) return known;
  if (size.ws_col > 0) known.columns = size.ws_col;
  if (size.ws_row > 0) known.rows = size.ws_row;
  return known;
}

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

void ProgressPrinter::begin_frame(int64_t number, size_t index, size_t count) {
  const std::lock_guard lock(mutex_);
  frame_ = number;
  frame_index_ = index;
  frame_count_ = count;
  last_shown_ = -1;
  interval_ = 1;
}

std::vector<std::string> ProgressPrinter::details(const Progress& progress) const {
  std::vector<std::string> parts = details_of(progress);
  if (frame_count_ > 0)
    parts.insert(parts.begin(), fmt::format("frame {} ({} of {})", frame_, frame_index_, frame_count_));
  return parts;
}

void ProgressPrinter::show_activity(const Activity::State& activity, double seconds) {
  const std::lock_guard lock(mutex_);
  const std::string what = activity.what;
  if (style_ == ProgressStyle::none || what.empty()) return;
  const std::string count = activity.total > 0  ? fmt::format(" {} of {}", activity.part, activity.total)
                            : activity.part > 0 ? fmt::format(" {}", activity.part)
                                                : "";
  if (style_ == ProgressStyle::bar)
    return show_over(joined({what + count, format_seconds(seconds)}, terminal_width() - 1));
  if (what == last_activity_) return;
  last_activity_ = what;
  if (style_ == ProgressStyle::lines) return tell_progress(what + "\n");
  const nlohmann::ordered_json j{
      {"activity", what}, {"seconds", seconds}, {"part", activity.part}, {"total", activity.total}};
  tell_progress(j.dump() + "\n");
}

ActivityPrinter::ActivityPrinter(const Activity& activity, ProgressPrinter& printer)
    : activity_(activity), printer_(printer) {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // Where the system gives no thread nothing is said.
  }
}

void ActivityPrinter::run() noexcept try {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  for (auto wait = first_word; !wake_.wait_for(lock, wait, [this] { return is_over_; }); wait = between_words)
    printer_.show_activity(activity_.state(),
                           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
} catch (const std::exception&) {
  // Out of memory: nothing more is said.
}

void ActivityPrinter::finish() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  wake_.notify_one();
  thread_.join();
  printer_.clear();
}

void ProgressPrinter::clear() {
  const std::lock_guard lock(mutex_);
  if (bar_open_) tell_progress("\r\x1b[K");
  bar_open_ = false;
  bar_.clear();
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
  bar_.clear();
  picture_lines_ = 0;
}

void ProgressPrinter::show_over(const std::string& line) {
  tell_progress("\r" + line + "\x1b[K");
  bar_open_ = true;
  bar_ = line;
}

void ProgressPrinter::show_picture(const std::vector<std::string>& lines, bool is_resized) {
  const std::lock_guard lock(mutex_);
  constexpr const char *hide_cursor = "\x1b[?25l", *show_cursor = "\x1b[?25h", *clear_all = "\x1b[H\x1b[2J",
                       *clear_line = "\r\x1b[2K";
  std::string text = hide_cursor;
  if (is_resized)
    text += clear_all;
  else if (picture_lines_ > 0)
    text += fmt::format("\x1b[{}A", picture_lines_);
  // A line that was longer, of a larger picture or the bar, leaves nothing.
  for (const std::string& line : lines) text += clear_line + line + "\n";
  text += clear_line + bar_ + show_cursor;
  tell_text(text);
  picture_lines_ = static_cast<int>(lines.size());
}

void ProgressPrinter::show_bar(const Progress& p) {
  const size_t width = terminal_width() - 1;
  std::string line = joined(details(p), width);
  if (line.size() + 12 < width) {
    const size_t length = std::min(longest_bar, width - line.size() - 3);
    const size_t filled = static_cast<size_t>(std::clamp(p.fraction, 0.0, 1.0) * static_cast<double>(length));
    line = "[" + std::string(filled, '#') + std::string(length - filled, '.') + "] " + line;
  }
  show_over(line);
}

/// Lines become less frequent as the render proceeds, so that a long one does not fill a log.
void ProgressPrinter::show_line(const Progress& p) {
  if (p.seconds < last_shown_ + interval_ && !(p.fraction >= 1 && last_shown_ >= 0)) return;
  if (p.seconds < 1 && p.fraction < 1) return;
  tell_progress(joined(details(p), std::string::npos / 2) + "\n");
  last_shown_ = p.fraction >= 1 ? 1e300 : p.seconds;
  interval_ = std::min(interval_ * 1.5, 60.0);
}

void ProgressPrinter::show_json(const Progress& p) {
  if (p.seconds < last_shown_ + 0.5 && p.fraction < 1) return;
  nlohmann::ordered_json j{{"fraction", p.fraction},
                           {"seconds", p.seconds},
                           {"seconds_left", seconds_left(p)},
                           {"samples_done", p.samples_done},
                           {"samples_total", p.samples_total},
                           {"samples_per_second", samples_per_second(p)},
                           {"noise", p.noise}};
  if (frame_count_ > 0) {
    j["frame"] = frame_;
    j["frame_index"] = frame_index_;
    j["frame_count"] = frame_count_;
  }
  tell_progress(j.dump() + "\n");
  last_shown_ = p.seconds;
}

}  // namespace alhazen::impl
