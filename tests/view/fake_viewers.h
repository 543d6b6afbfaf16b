#pragma once

// Pages without a network: what is sent to each is kept, and by default acknowledged.

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "view/frame_decoder.h"
#include "view/view_session.h"
#include "view/viewers.h"

namespace alhazen::impl::test {

using Clock = std::chrono::steady_clock;

class FakeViewers final : public ViewerSender {
 public:
  struct Sent {
    bool is_frame;
    nlohmann::json json;  ///< of a frame, its header
    std::string message;  ///< of a frame, all of it
    Clock::time_point at;
  };

  void send_text(ViewerId viewer, std::shared_ptr<const std::string> text) override {
    add(viewer, {false, nlohmann::json::parse(*text), {}, Clock::now()});
  }
  void send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes) override {
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length |= size_t{static_cast<uint8_t>(bytes->at(4 + i))} << (8 * i);
    add(viewer, {true, nlohmann::json::parse(bytes->substr(8, length)), *bytes, Clock::now()});
  }
  size_t queued_bytes(ViewerId) const override { return 0; }

  std::vector<Sent> sent(ViewerId viewer) const {
    const std::lock_guard lock(mutex_);
    const auto found = sent_.find(viewer);
    return found == sent_.end() ? std::vector<Sent>{} : found->second;
  }

  /// Waits for something that has been sent since the `first`-th; nothing if it does not come.
  std::optional<Sent> wait_for(ViewerId viewer, const std::function<bool(const Sent&)>& is_it, size_t first = 0,
                               double seconds = 60) {
    std::unique_lock lock(mutex_);
    std::optional<Sent> found;
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
      const std::vector<Sent>& all = sent_[viewer];
      for (; first < all.size(); ++first)
        if (is_it(all[first])) return found = all[first], true;
      return false;
    });
    return found;
  }

 private:
  void add(ViewerId viewer, Sent sent) {
    {
      const std::lock_guard lock(mutex_);
      sent_[viewer].push_back(std::move(sent));
    }
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ViewerId, std::vector<Sent>> sent_;
};

/// A session with pages, which acknowledge what they are sent on a thread of their own.
class FakeView {
 public:
  explicit FakeView(ViewOptions options) : session_(std::move(options), sender), events_(session_.events()) {
    pages_ = std::thread([this] { acknowledge(); });
    session_.start();
  }
  ~FakeView() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    pages_.join();
    session_.stop();
  }

  void open(ViewerId viewer, bool acknowledges = true) {
    events_.opened(viewer);
    {
      const std::lock_guard lock(mutex_);
      if (acknowledges) acknowledged_[viewer] = 0;
    }
    send(viewer, {{"type", "hello"}});
  }
  void close(ViewerId viewer) {
    {
      const std::lock_guard lock(mutex_);
      acknowledged_.erase(viewer);
    }
    events_.closed(viewer);
  }
  void send(ViewerId viewer, const nlohmann::json& message) { events_.message(viewer, message.dump()); }
  void send_camera(ViewerId viewer, const PageCamera& camera, bool moving, uint64_t id) {
    const nlohmann::json text = nlohmann::json::parse(camera_message(camera, {}))["camera"];
    send(viewer, {{"type", "camera"}, {"camera", text}, {"moving", moving}, {"id", id}});
  }
  PageResponse get(const std::string& path, const std::string& query = "") { return events_.get(path, query); }

  std::optional<FakeViewers::Sent> wait_for_frame(ViewerId viewer,
                                                  const std::function<bool(const nlohmann::json&)>& is_it,
                                                  size_t first = 0, double seconds = 60) {
    return sender.wait_for(
        viewer, [&](const FakeViewers::Sent& sent) { return sent.is_frame && is_it(sent.json); }, first, seconds);
  }
  std::optional<FakeViewers::Sent> wait_for_text(ViewerId viewer,
                                                 const std::function<bool(const nlohmann::json&)>& is_it,
                                                 size_t first = 0, double seconds = 60) {
    return sender.wait_for(
        viewer, [&](const FakeViewers::Sent& sent) { return !sent.is_frame && is_it(sent.json); }, first, seconds);
  }

  FakeViewers sender;

 private:
  void acknowledge() {
    for (;;) {
      std::vector<std::pair<ViewerId, uint64_t>> frames;
      {
        const std::lock_guard lock(mutex_);
        if (is_ending_) return;
        for (auto& [viewer, count] : acknowledged_) {
          const std::vector<FakeViewers::Sent> sent = sender.sent(viewer);
          for (; count < sent.size(); ++count)
            if (sent[count].is_frame) frames.emplace_back(viewer, sent[count].json["frame"]);
        }
      }
      for (const auto& [viewer, frame] : frames) send(viewer, {{"type", "ack"}, {"frame", frame}});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  ViewSession session_;
  PageEvents events_;
  std::mutex mutex_;
  std::map<ViewerId, size_t> acknowledged_;  ///< how much of what was sent to those that acknowledge
  bool is_ending_ = false;
  std::thread pages_;
};

}  // namespace alhazen::impl::test
