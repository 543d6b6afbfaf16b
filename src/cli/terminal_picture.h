#pragma once

// --terminal: the image so far is drawn in the terminal, above the progress bar.

#include <memory>
#include <mutex>

#include "cli/live_outputs.h"
#include "cli/progress.h"
#include "images/display/half_blocks.h"
#include "pipeline/write_outputs.h"

namespace alhazen::impl {

/// Throws InputError if standard error is no terminal on which this can be done.
void check_terminal();

class TerminalPicture final : public LiveOutput {
 public:
  /// `output` says how it is displayed, as PNG files are; both references must outlive this.
  TerminalPicture(const OutputOptions& output, ProgressPrinter& printer);

  void look(const Rendering& so_far) override;
  void finish(const Rendering& rendering) override;
  /// Draws what was looked at last if it is new, or if the terminal has another size. Called by the thread that reports
  /// progress, so that a slow terminal does not keep the one that renders.
  void draw();

 private:
  const OutputOptions& output_;
  ProgressPrinter& printer_;
  bool has_half_blocks_;
  std::mutex mutex_;
  ReducedImage image_;
  WriteOptions how_;
  bool is_new_ = false;
  TerminalSize size_;  ///< when it was drawn last
};

}  // namespace alhazen::impl
