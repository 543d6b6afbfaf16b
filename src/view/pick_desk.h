#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "view/page_server.h"
#include "view/protocol.h"

namespace alhazen::impl {

/// Answers what viewers ask about pixels on a thread of its own, since an answer may need another BVH and should not
/// wait for the end of a pass. Of each viewer the latest question is answered.
class PickDesk {
 public:
  /// `answer` must not throw.
  using Answer = std::function<void(ViewerId, const PickMessage&)>;

  explicit PickDesk(Answer answer);
  ~PickDesk();
  PickDesk(const PickDesk&) = delete;
  PickDesk& operator=(const PickDesk&) = delete;

  void ask(ViewerId viewer, const PickMessage& message);
  /// Waits for the answer under way; nothing is answered after it.
  void end();

 private:
  void run();

  Answer answer_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ViewerId, PickMessage> questions_;
  bool is_ending_ = false;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace alhazen::impl
