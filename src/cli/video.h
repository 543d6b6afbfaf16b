#pragma once

// Videos, which the program ffmpeg encodes from frames that are piped to it.

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "util/diagnostics.h"

namespace alhazen::impl {

/// By the extension: mp4 or gif.
bool is_video(const std::string& path);

/// Throws InputError if ffmpeg is not installed, or if `path` cannot be written.
void check_video(const std::string& path);

/// The rate at which a video can play, the nearest to the one asked for. The delays of a GIF are hundredths of a second
/// in 16 bits, of which players show 0 and 1 as 10: at most 50 frames per second, and at least one in 655.35 seconds.
double playable_rate(const std::string& path, double frames_per_second);

/// ffmpeg did not go on after an interrupt, and was ended.
class VideoInterrupted : public RenderError {
 public:
  using RenderError::RenderError;
};

/// Writes a video completely or not at all: ffmpeg writes a temporary file beside the target, which finish() renames.
/// No shell runs. Throws RenderError with the last lines of ffmpeg where that fails, and VideoInterrupted if ffmpeg
/// stands still when the program is asked to end.
class VideoWriter {
 public:
  VideoWriter(const std::string& path, int width, int height, double frames_per_second);
  /// Ends ffmpeg and removes what it has written, unless it was finished.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// Three bytes of sRGB per pixel, rows from the top.
  void add(std::span<const uint8_t> frame);
  /// Waits for ffmpeg and gives the file its name.
  void finish();

 private:
  void create_temporary();
  void start(double frames_per_second);
  void send(std::span<const uint8_t> bytes);
  bool has_ended();
  bool stands_still();
  void wait();
  void wait_briefly();
  void end();
  void check_written();
  std::string messages() const;
  std::string how_it_ended() const;
  [[noreturn]] void fail(const std::string& problem);
  [[noreturn]] void give_up();

  std::string path_, target_, temporary_;
  int width_, height_;
  std::vector<uint8_t> padded_;  ///< a frame with even sides
  pid_t process_ = -1;
  int pipe_ = -1, lock_ = -1, messages_ = -1;
  int status_ = 0;
  double asked_at_ = 0;                ///< seconds; when an interrupt was first seen
  double worked_at_ = 0, worked_ = 0;  ///< seconds; when ffmpeg last had used the processor, and how long
};

}  // namespace alhazen::impl
