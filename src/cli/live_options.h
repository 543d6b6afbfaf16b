#pragma once

// The options of `alhazen render` for seeing an image while it is rendered.

#include <functional>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/live_outputs.h"
#include "cli/render_options.h"
#include "cli/terminal_picture.h"

namespace alhazen::impl {

/// `options` must outlive the parsing.
void add_live_options(Command& command, RenderOptions& options, const std::string& group);

/// Throws InputError for those that cannot be together, before anything is read.
void check_live_options(const RenderOptions& options);

/// All that is live about one render or a sequence.
class LiveRender {
 public:
  /// The outputs must be chosen. `warn` is called on the thread that renders; `options` and `printer` must outlive
  /// this.
  LiveRender(const RenderOptions& options, ProgressPrinter& printer, std::function<void(const std::string&)> warn);

  /// Of each image: its watcher, which may be null, to be told before it begins, and the finished image.
  RenderWatcher* begin(const std::string& name);
  void finish(const Rendering& rendering);
  /// Called by the thread that reports progress.
  void draw();

 private:
  LiveOutputs outputs_;
  TerminalPicture* terminal_ = nullptr;  ///< one of them
};

/// What an image with these outputs is called where it is shown.
std::string shown_name(const std::vector<std::string>& paths, const std::string& scene);

}  // namespace alhazen::impl
