#include "cli/frames.h"

#include <fmt/format.h>

#include <string_view>

#include "util/diagnostics.h"
#include "util/parse_numbers.h"

namespace alhazen::impl {

namespace {

constexpr int max_width = 9;

[[noreturn]] void refuse_range(const std::string& text, const std::string& reason) {
  throw InputError("--frames takes FIRST..LAST, FIRST..LAST:STEP or one number, such as 0..47, and not '" + text +
                   "': " + reason);
}

int64_t frame_number(const std::string& text, std::string_view part) {
  int64_t number = 0;
  if (!parse_number(part, number)) refuse_range(text, "'" + std::string(part) + "' is no whole number");
  if (number < 0) refuse_range(text, "frames are numbered from 0");
  if (number > max_frame_number)
    refuse_range(text, "the numbers of frames are at most " + std::to_string(max_frame_number));
  return number;
}

size_t start_of_name(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

[[noreturn]] void refuse_pattern(const std::string& path, const std::string& reason) {
  throw InputError({path}, reason + ": write the number of the frame as %04d or ####, once, and a percent sign as %%");
}

}  // namespace

std::vector<int64_t> FrameRange::numbers() const {
  std::vector<int64_t> all;
  for (int64_t frame = first; frame <= last; frame += step) all.push_back(frame);
  return all;
}

FrameRange parse_frame_range(const std::string& text) {
  const std::string_view view = text;
  FrameRange range;
  const size_t dots = view.find(".."), colon = view.find(':');
  if (dots == std::string::npos) {
    if (colon != std::string::npos) refuse_range(text, "a step needs a first and a last frame");
    range.first = range.last = frame_number(text, view);
    return range;
  }
  if (colon != std::string::npos && colon < dots) refuse_range(text, "the step is the last part");
  range.first = frame_number(text, view.substr(0, dots));
  const size_t end = colon == std::string::npos ? view.size() : colon;
  range.last = frame_number(text, view.substr(dots + 2, end - dots - 2));
  if (colon != std::string::npos) range.step = frame_number(text, view.substr(colon + 1));
  if (range.step == 0) refuse_range(text, "the step is at least 1");
  if (range.last < range.first) refuse_range(text, "the last frame is before the first");
  if (range.count() > max_frames)
    refuse_range(text, "that is " + std::to_string(range.count()) + " frames, and at most " +
                           std::to_string(max_frames) + " are rendered at once");
  return range;
}

FramePattern::FramePattern(const std::string& path) {
  const size_t start = start_of_name(path);
  before_ = path.substr(0, start);
  const auto literal = [&](char c) { (has_number() ? after_ : before_) += c; };
  const auto found = [&](int width) {
    if (has_number()) refuse_pattern(path, "the name has two places for the number of the frame");
    width_ = width;
  };
  for (size_t i = start; i < path.size(); ++i) {
    if (path[i] == '#') {
      size_t end = i;
      while (end < path.size() && path[end] == '#') ++end;
      if (end - i > static_cast<size_t>(max_width)) refuse_pattern(path, "a number has at most 9 digits");
      found(static_cast<int>(end - i));
      i = end - 1;
    } else if (path[i] != '%') {
      literal(path[i]);
    } else if (i + 1 < path.size() && path[i + 1] == '%') {
      literal(path[i++]);
    } else {
      const size_t end = path.find_first_not_of("0123456789", i + 1);
      const std::string digits = end == std::string::npos ? "" : path.substr(i + 1, end - i - 1);
      if (end == std::string::npos || path[end] != 'd')
        refuse_pattern(path, "a % in the name of a frame begins %d or %04d");
      if (digits.size() > 2 || (!digits.empty() && digits[0] != '0') || digits == "0" || digits == "00")
        refuse_pattern(path, "a number has at most 9 digits, filled up with zeros");
      found(digits.empty() ? 1 : digits[1] - '0');
      i = end;
    }
  }
}

std::string FramePattern::path_of(int64_t frame) const {
  return has_number() ? fmt::format("{}{:0{}}{}", before_, frame, width_, after_) : before_ + after_;
}

bool FramePattern::is_likely(const std::string& path) {
  for (size_t i = start_of_name(path); i < path.size(); ++i) {
    if (path.compare(i, 2, "##") == 0) return true;
    if (path[i] != '%') continue;
    const size_t end = path.find_first_not_of("0123456789", i + 1);
    if (end != std::string::npos && path[end] == 'd') return true;
  }
  return false;
}

}  // namespace alhazen::impl
