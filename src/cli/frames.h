#pragma once

// Which frames are rendered, and what their files are called.

#include <cstdint>
#include <string>
#include <vector>

namespace alhazen::impl {

/// A sequence has at most this many frames, and their numbers are at most that.
inline constexpr int64_t max_frames = 1'000'000, max_frame_number = 999'999'999;

struct FrameRange {
  int64_t first = 0, last = 0, step = 1;

  int64_t count() const { return (last - first) / step + 1; }
  std::vector<int64_t> numbers() const;
};

/// Parses "A..B", "A..B:STEP" or "A", whole numbers from 0. Throws InputError.
FrameRange parse_frame_range(const std::string& text);

/// The name of a file with a place for the number of the frame: %d, %04d or ####, in the last part of the path.
class FramePattern {
 public:
  /// Throws InputError if the name has more than one place for the number, or a % that is none. %% is a %.
  explicit FramePattern(const std::string& path);

  bool has_number() const { return width_ > 0; }
  /// The path of a frame.
  std::string path_of(int64_t frame) const;

  /// Returns whether a name looks like one with a place for a number.
  static bool is_likely(const std::string& path);

 private:
  std::string before_, after_;
  int width_ = 0;  ///< digits, filled up with zeros; 0: there is no place for a number
};

}  // namespace alhazen::impl
