#pragma once

// The options of `alhazen render` that are about images for displays, PNG and JPEG.

#include <functional>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "cli/command.h"
#include "pipeline/write_outputs.h"
#include "render/statistics.h"

namespace alhazen::impl {

/// As given; empty: not given.
struct DisplayOptions {
  std::string exposure, white_balance, tone_map, png_depth, jpeg_quality;
};

/// `options` must outlive the parsing.
void add_display_options(Command& command, DisplayOptions& options, const std::string& group);

/// Puts them where images are written, and where noise is measured as it is displayed. Throws InputError that names the
/// option and what it may be.
void parse_display_options(const DisplayOptions& options, OutputOptions& output, Settings& settings);

/// Calls `warn(option, reason)` for each that changes nothing. `limits_noise`: a noise target is of what is displayed.
void warn_of_display_options(const DisplayOptions& options, const std::vector<std::string>& outputs, bool limits_noise,
                             const std::function<void(const std::string&, const std::string&)>& warn);

/// What the image decided on, one line each; empty if it was as given.
std::string display_lines(const DisplayStatistics& display);

}  // namespace alhazen::impl
