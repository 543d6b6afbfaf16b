#pragma once

// Videos, which the program ffmpeg encodes from frames that are piped to it.

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace alhazen::impl {

/// By the extension: mp4 or gif.
bool is_video(const std::string& path);

/// Throws InputError if ffmpeg is not installed, or if `path` cannot be written.
void check_video(const std::string& path);

/// Writes a video completely or not at all: ffmpeg writes a temporary file beside the target, which finish() renames.
/// No shell runs. Throws RenderError with the last lines of ffmpeg where that fails.
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
  void wait();
  void end();
  [[noreturn]] void fail(const std::string& problem);

  std::string path_, target_, temporary_;
  int width_, height_;
  std::vector<uint8_t> padded_;  ///< a frame with even sides
  pid_t process_ = -1;
  int pipe_ = -1, lock_ = -1, messages_ = -1;
  int status_ = 0;
};

}  // namespace alhazen::impl
