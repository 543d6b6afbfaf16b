#pragma once

// --view: a page shows the image so far (view/live_feed.h).

#include <functional>
#include <memory>
#include <string>

#include "alhazen/alhazen.h"
#include "cli/live_outputs.h"
#include "pipeline/write_outputs.h"

namespace alhazen::impl {

class ViewOutput : public LiveOutput {
 public:
  /// Where its page is.
  virtual std::string url() const = 0;
  /// Called by the thread that reports progress.
  virtual void report(const Progress& progress) = 0;
  virtual void say(const std::string& warning) = 0;
};

struct ViewOutputOptions {
  int port = 0;           ///< 0: any free one
  OutputOptions outputs;  ///< that a page may have written; without paths none
  /// Ends the render as an interrupt does. Any thread may call it.
  std::function<void()> stop;
};

/// Throws InputError if it cannot listen.
std::unique_ptr<ViewOutput> make_view_output(ViewOutputOptions options);

}  // namespace alhazen::impl
