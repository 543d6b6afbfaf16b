#pragma once

// The page of a render that is under way: the same as that of `alhazen view`, but read-only. Nothing is copied or sent
// while no page is open.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "view/noise_curve.h"
#include "view/page_server.h"
#include "view/protocol.h"
#include "view/view_renderer.h"
#include "view/viewers.h"

namespace alhazen::impl {

/// What pages may ask for, on a thread of the server.
struct LiveFeedEvents {
  std::function<void()> stop;  ///< ends the render as an interrupt does
  std::function<void()> save;  ///< writes the outputs as soon as it can
};

class LiveFeed {
 public:
  /// Serves at once. Throws InputError as PageServer does.
  LiveFeed(const PageServerOptions& options, LiveFeedEvents events);
  ~LiveFeed();
  LiveFeed(const LiveFeed&) = delete;
  LiveFeed& operator=(const LiveFeed&) = delete;

  std::string url() const { return server_->url(); }

  // Called by the thread that renders.

  /// An image begins: its name, size and layers, and all else that pages are told of it.
  void begin(const SceneText& scene);
  /// The layers that pages look at; empty while none is open.
  std::set<std::string> wanted_layers() const;
  /// Whether a page looks at a layer that the picture so far does not have.
  bool is_waited_for() const;
  /// A picture with at least the layers that are wanted, and what files of it say.
  void show(const ViewImage& image);
  void say(const std::string& warning);
  /// Waits until every page has drawn the last picture, but at most so many seconds.
  void flush(double patience);
  /// Processor time that was spent on sending since this was asked last.
  double take_seconds();

  // Called by any thread.

  void report(const Progress& progress);

 private:
  class Sender;

  void handle_message(ViewerId viewer, std::string_view text);
  void handle(ViewerId viewer, const PageMessage& message);
  void greet(ViewerId viewer);
  void send_status();
  PageResponse get(const std::string& path, const std::string& query) const;

  LiveFeedEvents events_;
  std::unique_ptr<Sender> sender_;
  std::unique_ptr<Viewers> viewers_;
  mutable std::mutex mutex_;  ///< of what follows
  std::optional<SceneText> scene_;
  StatusText status_;
  NoiseCurve curve_;
  ViewImage image_;
  std::string scene_name_;
  uint64_t number_ = 0, view_ = 0;
  std::unique_ptr<PageServer> server_;  ///< the last member: its threads use the others
};

}  // namespace alhazen::impl
