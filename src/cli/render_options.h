#pragma once

// The options of `alhazen render`, and what it says of images, one or a sequence of them.

#include <optional>
#include <string>

#include "cli/display_options.h"
#include "cli/progress.h"
#include "pipeline/write_outputs.h"

namespace alhazen::impl {

struct RenderOptions {
  std::string scene;
  Settings settings;
  OutputOptions output;
  DisplayOptions display;
  std::string exr_type, exr_compression;  ///< empty: half and zip
  std::string format;                     ///< of standard output; empty: png
  std::string frames;                     ///< a range; empty: one image, or with a turntable all frames
  int64_t turntable = 0;                  ///< frames of a turn; 0: none
  std::string progress = "auto", stats, config;
  bool quiet = false, verbose = false, list = false;
  double write_every = 0;  ///< seconds; 0: only at the end
  std::string tev;         ///< an address; empty: none
  bool terminal = false;

  bool is_sequence() const { return !frames.empty() || turntable != 0; }
};

/// Warns of options that change nothing: what they are about is not written, or not used.
void warn_of_options_without_effect(const RenderOptions& options, const RenderSettings& settings,
                                    Diagnostics& diagnostics);

/// Says what is rendered and how.
void print_start(const RenderStatistics& statistics);

/// Says what was rendered and written, after `head`, and prints the statistics, with the number of the frame if it is
/// one.
void print_end(const RenderOptions& options, const OutputReport& outputs, const RenderStatistics& statistics,
               const std::string& head = {}, std::optional<int64_t> frame = {});

/// Prints new warnings each time it is called.
class WarningPrinter {
 public:
  WarningPrinter(const Diagnostics& diagnostics, ProgressPrinter& printer)
      : diagnostics_(diagnostics), printer_(printer) {}

  void show();

 private:
  const Diagnostics& diagnostics_;
  ProgressPrinter& printer_;
  size_t shown_ = 0;
};

}  // namespace alhazen::impl
