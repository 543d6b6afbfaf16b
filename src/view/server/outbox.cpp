#include "view/server/outbox.h"

#include <utility>

namespace alhazen::impl {

bool Outbox::push(OutgoingMessage message) {
  std::deque<OutgoingMessage> dropped;  // destroyed after the lock is
  const std::lock_guard lock(mutex_);
  if (is_closed_) return false;
  const size_t size = message.bytes->size();
  if (!waiting_.empty() && (size > max_bytes_ || waiting_bytes_ > max_bytes_ - size)) {
    has_overflowed_ = is_closed_ = true;
    waiting_bytes_ = 0;
    dropped.swap(waiting_);
    return true;
  }
  waiting_.push_back(std::move(message));
  waiting_bytes_ += size;
  return !std::exchange(is_sending_, true);
}

std::optional<OutgoingMessage> Outbox::take() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) {
    is_sending_ = false;
    return std::nullopt;
  }
  OutgoingMessage message = std::move(waiting_.front());
  waiting_.pop_front();
  being_sent_ = message.bytes->size();
  waiting_bytes_ -= being_sent_;
  return message;
}

void Outbox::sent() {
  const std::lock_guard lock(mutex_);
  being_sent_ = 0;
}

void Outbox::close() {
  std::deque<OutgoingMessage> dropped;
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  waiting_bytes_ = being_sent_ = 0;
  dropped.swap(waiting_);
}

size_t Outbox::bytes() const {
  const std::lock_guard lock(mutex_);
  return waiting_bytes_ + being_sent_;
}

bool Outbox::has_overflowed() const {
  const std::lock_guard lock(mutex_);
  return has_overflowed_;
}

}  // namespace alhazen::impl
