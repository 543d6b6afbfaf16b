#pragma once

// Shows the progress of a render on stderr: a bar on a terminal, lines elsewhere, JSON for programs.

#include <mutex>
#include <string>

#include "alhazen/alhazen.h"

namespace alhazen {

enum class ProgressStyle { bar, lines, json, none };

/// `name` is auto, plain, json or none. Throws InputError.
ProgressStyle parse_progress_style(const std::string& name);

class ProgressPrinter {
 public:
  explicit ProgressPrinter(ProgressStyle style) : style_(style) {}
  /// Prints the progress when the style requires it.
  void show(const Progress& progress);
  /// Ends the bar's line.
  void finish();
  /// Prints other lines, from any thread, while progress is shown.
  void tell_lines(const std::string& lines);

 private:
  void show_bar(const Progress& progress);
  void show_line(const Progress& progress);
  void show_json(const Progress& progress);
  void end_bar();

  std::mutex mutex_;
  ProgressStyle style_;
  double last_shown_ = -1;
  double interval_ = 1;
  bool bar_open_ = false;
};

/// 3725 as "1 h 02 min", 75.2 as "1 min 15 s", 4.21 as "4.2 s".
std::string format_seconds(double seconds);

}  // namespace alhazen
