#pragma once

// A PageServer that sends every message back, and counts what happens.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "view/page_server.h"

namespace alhazen::impl {

/// Returns false if it does not come true in time.
inline bool comes_true(const std::function<bool()>& condition,
                       std::chrono::milliseconds time = std::chrono::seconds(20)) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

class EchoServer {
 public:
  explicit EchoServer(PageServerOptions options = {}) {
    options.token = token;
    PageEvents events;
    events.opened = [this](ViewerId viewer) {
      last = viewer;
      ++opened;
    };
    events.closed = [this](ViewerId) { ++closed; };
    events.message = [this](ViewerId viewer, std::string_view text) {
      ++messages;
      if (on_message) on_message(text);
      if (auto* page_server = server_of_events.load())
        page_server->send_text(viewer, std::make_shared<const std::string>(text));
    };
    events.get = [this](const std::string& path, const std::string& query) {
      PageResponse response;
      if (path == "slow") {
        is_slow_one_running = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
      } else if (path == "throws") {
        throw std::runtime_error("it cannot be done");
      } else if (path == "large") {
        response.body.assign(size_t{20} << 20, 'x');
        return response;
      } else if (path != "save.exr") {
        response.status = 404;
        response.body = "no such thing\n";
        return response;
      }
      response.content_type = "image/x-exr";
      response.file_name = "Kugel \"ü\"\r\nX-Evil: 1.exr";
      response.body = path + '?' + query;
      return response;
    };
    server = std::make_unique<PageServer>(options, events);
    server_of_events = server.get();
  }
  ~EchoServer() { stop(); }

  void stop() {
    server.reset();
    server_of_events = nullptr;
  }

  int port() const { return server->port(); }

  static constexpr const char* token = "secret";
  std::atomic<ViewerId> last{0};
  std::atomic<int> opened{0}, closed{0}, messages{0};
  std::atomic<bool> is_slow_one_running{false};
  std::function<void(std::string_view)> on_message;
  std::unique_ptr<PageServer> server;
  std::atomic<PageServer*> server_of_events{nullptr};
};

}  // namespace alhazen::impl
