#pragma once

// Shows the progress of a render on stderr: a bar on a terminal, lines elsewhere, JSON for programs.

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "alhazen/alhazen.h"
#include "util/activity.h"

namespace alhazen::impl {

/// Of the terminal on standard error; 80 by 24 if it does not say.
struct TerminalSize {
  int columns = 0, rows = 0;
  bool operator==(const TerminalSize&) const = default;
};
TerminalSize terminal_size();

enum class ProgressStyle { bar, lines, json, none };

/// `name` is auto, plain, json or none. Throws InputError.
ProgressStyle parse_progress_style(const std::string& name);

class ProgressPrinter {
 public:
  explicit ProgressPrinter(ProgressStyle style) : style_(style) {}
  /// Prints the progress when the style requires it.
  void show(const Progress& progress);
  /// From now on progress is that of the frame with this number, the `index`-th of `count`, from 1.
  void begin_frame(int64_t number, size_t index, size_t count);
  /// Says what is done before the render begins; `seconds` since the start.
  void show_activity(const Activity::State& activity, double seconds);
  /// Shows lines above the bar, on a terminal, in place of those that were shown last if nothing was printed since.
  /// `is_resized`: since then the terminal has put them elsewhere, so it is cleared.
  void show_picture(const std::vector<std::string>& lines, bool is_resized);
  /// Ends the bar's line.
  void finish();
  /// Takes the bar's line away.
  void clear();
  /// Prints other lines, from any thread, while progress is shown.
  void tell_lines(const std::string& lines);

 private:
  void show_over(const std::string& line);
  void show_bar(const Progress& progress);
  void show_line(const Progress& progress);
  void show_json(const Progress& progress);
  void end_bar();
  /// What is said of progress beside the fraction.
  std::vector<std::string> details(const Progress& progress) const;

  std::mutex mutex_;
  ProgressStyle style_;
  double last_shown_ = -1;
  double interval_ = 1;
  bool bar_open_ = false;
  std::string bar_;        ///< the line
  int picture_lines_ = 0;  ///< above the line of the cursor
  std::string last_activity_;
  int64_t frame_ = 0;
  size_t frame_index_ = 0, frame_count_ = 0;  ///< 0: it is one image
};

/// While one exists, what is done is said at most 0.2 s after its beginning.
class ActivityPrinter {
 public:
  ActivityPrinter(const Activity& activity, ProgressPrinter& printer);
  ~ActivityPrinter() { finish(); }
  ActivityPrinter(const ActivityPrinter&) = delete;
  ActivityPrinter& operator=(const ActivityPrinter&) = delete;
  /// Says no more.
  void finish();

 private:
  void run() noexcept;

  const Activity& activity_;
  ProgressPrinter& printer_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_over_ = false;
  std::thread thread_;
};

/// 3725 as "1 h 02 min", 75.2 as "1 min 15 s", 4.21 as "4.2 s".
std::string format_seconds(double seconds);

}  // namespace alhazen::impl
