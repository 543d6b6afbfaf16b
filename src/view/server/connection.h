#pragma once

// What the server asks of a connection, of either protocol. All on the server's thread.

#include <chrono>
#include <memory>

namespace alhazen::impl {

using ServerClock = std::chrono::steady_clock;

class Connection {
 public:
  virtual ~Connection() = default;

  /// Ends it where it has waited for the other side for too long. Called about once a second.
  virtual void check_time(ServerClock::time_point now) = 0;
  /// Ends it soon: what is about to be sent may still be.
  virtual void finish() = 0;
  /// Ends it at once.
  virtual void drop() = 0;
};

}  // namespace alhazen::impl
