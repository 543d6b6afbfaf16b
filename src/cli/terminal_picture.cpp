#include "cli/terminal_picture.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>

#include "cli/interrupt.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// A terminal that has more columns or rows than this gets a picture of this size.
constexpr int max_side = 512;

/// Lines below the picture: the bar, and an empty one where the terminal has put what a user typed.
constexpr int lines_below = 2;

/// By the variables of POSIX that name the character set; the first that is set counts.
bool has_utf8() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(variable);
    if (!value || *value == '\0') continue;
    std::string name = value;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name.find("utf-8") != std::string::npos || name.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace

void check_terminal() {
  if (!isatty(STDERR_FILENO))
    throw InputError(
        "--terminal draws in the terminal, and standard error is not one: leave it out, or do not redirect it");
  const char* const kind = std::getenv("TERM");
  if (!kind || *kind == '\0' || std::string(kind) == "dumb")
    throw InputError(std::string("--terminal needs a terminal with colours, and the variable TERM ") +
                     (kind && *kind ? "is '" + std::string(kind) + "'" : "is not set"));
}

TerminalPicture::TerminalPicture(const OutputOptions& output, ProgressPrinter& printer)
    : output_(output), printer_(printer), has_half_blocks_(has_utf8()) {
  // Colours, and a cursor that is seen again, for an end in the middle of drawing.
  write_before_ending("\x1b[0m\x1b[?25h");
}

void TerminalPicture::look(const Rendering& so_far) {
  WriteOptions how = output_.how;
  choose_display(so_far, output_.display, how);
  ReducedImage image = reduce_image(so_far.source(), max_side, max_side);
  const std::lock_guard lock(mutex_);
  image_ = std::move(image);
  how_ = std::move(how);
  is_new_ = true;
}

void TerminalPicture::finish(const Rendering& rendering) {
  look(rendering);
  draw();
}

void TerminalPicture::draw() {
  const TerminalSize size = terminal_size();
  const std::lock_guard lock(mutex_);
  if (image_.rgb.empty() || (!is_new_ && size == size_)) return;
  const bool is_resized = size_.columns != 0 && size != size_;
  is_new_ = false;
  size_ = size;
  // A character is about twice as high as wide, so it stands for two pixels.
  const ReducedImage fitted = reduce_image(image_, std::max(1, size.columns), std::max(1, size.rows - lines_below) * 2);
  printer_.show_picture(terminal_lines(fitted, DisplayTransform(how_), has_half_blocks_), is_resized);
}

}  // namespace alhazen::impl
