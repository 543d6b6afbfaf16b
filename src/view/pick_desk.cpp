#include "view/pick_desk.h"

#include <utility>

#include "util/thread_limit.h"

namespace alhazen::impl {

PickDesk::PickDesk(Answer answer)
    : answer_(std::move(answer)), thread_(start_thread("the thread that finds what pixels show", [this] { run(); })) {}

PickDesk::~PickDesk() { end(); }

void PickDesk::ask(ViewerId viewer, const PickMessage& message) {
  const std::lock_guard lock(mutex_);
  questions_[viewer] = message;
  changed_.notify_one();
}

void PickDesk::end() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void PickDesk::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_ending_ || !questions_.empty(); });
    if (is_ending_) return;
    const auto [viewer, message] = *questions_.begin();
    questions_.erase(questions_.begin());
    lock.unlock();
    answer_(viewer, message);
    lock.lock();
  }
}

}  // namespace alhazen::impl
