#pragma once

// What the connections of a server share: who is there, and what the program is asked.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "view/page_server.h"
#include "view/server/allowed_hosts.h"
#include "view/server/asio.h"
#include "view/server/connection.h"

namespace alhazen::impl {

class Viewer;

/// Runs its argument soon, on a thread that may take its time.
using RunSlowly = std::function<void(std::function<void()>)>;

/// All on the server's thread, where nothing else is said.
class Hub {
 public:
  Hub(net::io_context& context, const PageServerOptions& options, PageEvents events, AllowedHosts hosts,
      RunSlowly run_slowly)
      : context_(context),
        options_(options),
        events_(std::move(events)),
        hosts_(std::move(hosts)),
        run_slowly_(std::move(run_slowly)) {}

  net::io_context& context() { return context_; }
  const PageServerOptions& options() const { return options_; }
  const AllowedHosts& hosts() const { return hosts_; }
  void run_slowly(std::function<void()> job) { run_slowly_(std::move(job)); }

  void add(std::shared_ptr<Connection> connection);
  void remove(Connection* connection);
  size_t connections() const { return connections_.size(); }
  std::function<void()> on_remove;  ///< after a connection has gone

  /// The slot of a viewer, which others do not get until the result is destroyed. Empty if there is none.
  std::shared_ptr<void> reserve_viewer();
  ViewerId next_id() { return ++last_id_; }

  void opened(ViewerId id, const std::shared_ptr<Viewer>& viewer);
  void message(ViewerId id, std::string_view text);
  void closed(ViewerId id);
  PageResponse get(const std::string& path, const std::string& query);  ///< from any thread
  static PageResponse failure(int status, const std::string& sentence);

  void check_times();
  /// Every connection is to end, and the program is told nothing more.
  void finish();
  bool is_finishing() const { return is_finishing_; }

  /// From any thread: a viewer that is open, or null.
  std::shared_ptr<Viewer> viewer(ViewerId id) const;
  size_t viewers() const;  ///< from any thread

 private:
  std::vector<std::shared_ptr<Connection>> all_connections() const;

  /// Calls what the program has given. What that throws, against its promise, ends here.
  template <class Function, class... Arguments>
  void tell(const Function& function, Arguments... arguments) {
    if (!function || is_finishing_) return;
    try {
      function(arguments...);
    } catch (...) {  // NOLINT(bugprone-empty-catch)
    }
  }

  net::io_context& context_;
  const PageServerOptions options_;
  const PageEvents events_;
  const AllowedHosts hosts_;
  const RunSlowly run_slowly_;
  std::map<Connection*, std::shared_ptr<Connection>> connections_;
  std::shared_ptr<std::atomic<size_t>> reserved_ = std::make_shared<std::atomic<size_t>>(0);
  ViewerId last_id_ = 0;
  std::atomic<bool> is_finishing_{false};
  mutable std::mutex mutex_;  ///< of the following
  std::map<ViewerId, std::shared_ptr<Viewer>> viewers_;
};

inline void Hub::add(std::shared_ptr<Connection> connection) {
  Connection* key = connection.get();
  connections_.emplace(key, std::move(connection));
}

inline void Hub::remove(Connection* connection) {
  if (connections_.erase(connection) > 0 && on_remove) on_remove();
}

inline std::shared_ptr<void> Hub::reserve_viewer() {
  if (*reserved_ >= options_.max_viewers) return nullptr;
  auto slot = std::shared_ptr<void>(this, [count = reserved_](void*) { --*count; });
  ++*reserved_;
  return slot;
}

inline void Hub::opened(ViewerId id, const std::shared_ptr<Viewer>& viewer) {
  {
    const std::lock_guard lock(mutex_);
    viewers_.emplace(id, viewer);
  }
  tell(events_.opened, id);
}

inline void Hub::message(ViewerId id, std::string_view text) { tell(events_.message, id, text); }

inline void Hub::closed(ViewerId id) {
  {
    const std::lock_guard lock(mutex_);
    viewers_.erase(id);
  }
  tell(events_.closed, id);
}

inline PageResponse Hub::failure(int status, const std::string& sentence) {
  PageResponse response;
  response.status = status;
  response.body = sentence + '\n';
  return response;
}

inline PageResponse Hub::get(const std::string& path, const std::string& query) {
  if (!events_.get || is_finishing_) return failure(404, "There is nothing here.");
  try {
    return events_.get(path, query);
  } catch (const std::exception& error) {
    return failure(500, error.what());
  } catch (...) {
    return failure(500, "This failed.");
  }
}

inline std::vector<std::shared_ptr<Connection>> Hub::all_connections() const {
  std::vector<std::shared_ptr<Connection>> result;
  result.reserve(connections_.size());
  for (const auto& [key, connection] : connections_) result.push_back(connection);
  return result;
}

inline void Hub::check_times() {
  const auto now = ServerClock::now();
  for (const auto& connection : all_connections()) connection->check_time(now);
}

inline void Hub::finish() {
  is_finishing_ = true;
  for (const auto& connection : all_connections()) connection->finish();
}

inline std::shared_ptr<Viewer> Hub::viewer(ViewerId id) const {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(id);
  return found == viewers_.end() ? nullptr : found->second;
}

inline size_t Hub::viewers() const {
  const std::lock_guard lock(mutex_);
  return viewers_.size();
}

}  // namespace alhazen::impl
