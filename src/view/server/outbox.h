#pragma once

// What waits to be sent to one viewer. Any thread fills it, that of the server empties it.

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace alhazen::impl {

struct OutgoingMessage {
  std::shared_ptr<const std::string> bytes;
  bool is_binary = false;
};

class Outbox {
 public:
  explicit Outbox(size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns whether the thread of the server must look: it sends nothing at the moment, or there is too much.
  /// What comes after `close` is dropped. One message may be larger than the limit, if no other one waits.
  bool push(OutgoingMessage message);

  /// The next one to be sent. Those that return nothing are followed by a `push` that returns true.
  std::optional<OutgoingMessage> take();
  void sent();  ///< the one that was taken
  void close();

  size_t bytes() const;  ///< with the message that is being sent
  bool has_overflowed() const;

 private:
  mutable std::mutex mutex_;
  std::deque<OutgoingMessage> waiting_;
  size_t waiting_bytes_ = 0;
  size_t being_sent_ = 0;
  const size_t max_bytes_;
  bool is_sending_ = false;
  bool is_closed_ = false;
  bool has_overflowed_ = false;
};

}  // namespace alhazen::impl
