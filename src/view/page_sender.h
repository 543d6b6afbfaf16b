#pragma once

#include <mutex>

#include "view/page_server.h"
#include "view/viewers.h"

namespace alhazen::impl {

/// Sends by a server, which needs whom it serves first. While there is none, nothing is sent.
class PageSender : public ViewerSender {
 public:
  /// The server, or null before it ends.
  void set_server(PageServer* server) {
    const std::lock_guard lock(mutex_);
    server_ = server;
  }

  void send_text(ViewerId viewer, std::shared_ptr<const std::string> text) override {
    const std::lock_guard lock(mutex_);
    if (server_) server_->send_text(viewer, std::move(text));
  }
  void send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes) override {
    const std::lock_guard lock(mutex_);
    if (server_) server_->send_binary(viewer, std::move(bytes));
  }
  size_t queued_bytes(ViewerId viewer) const override {
    const std::lock_guard lock(mutex_);
    return server_ ? server_->queued_bytes(viewer) : 0;
  }

 private:
  mutable std::mutex mutex_;
  PageServer* server_ = nullptr;
};

}  // namespace alhazen::impl
