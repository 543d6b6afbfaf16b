#include "view/page_server.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "util/diagnostics.h"
#include "util/printable.h"
#include "util/thread_limit.h"
#include "view/server/get_thread.h"
#include "view/server/http_connection.h"
#include "view/server/hub.h"
#include "view/server/listen.h"
#include "view/server/token.h"
#include "view/server/viewer.h"

namespace alhazen::impl {

namespace {

/// Connections beside those of viewers: requests take one each, and browsers open some in advance.
constexpr size_t other_connections = 64;
constexpr auto time_to_finish = std::chrono::milliseconds(500);
constexpr auto time_between_checks = std::chrono::seconds(1);
/// Until connections are accepted again after the system had no descriptors or memory left for one.
constexpr auto time_of_shortage = std::chrono::milliseconds(200);

PageServerOptions completed(PageServerOptions options) {
  if (options.token.empty()) options.token = random_token();
  if (!is_token(options.token))
    throw InputError("token '" + printable(options.token) + "': it has letters, digits, '-' and '_' alone");
  return options;
}

}  // namespace

class PageServer::Implementation {
 public:
  Implementation(const PageServerOptions& options, PageEvents events)
      : listening_(options.address, options.port, options.only_this_port),
        port_(listening_.port()),
        url_("http://" + listening_.url_host() + ':' + std::to_string(port_) + '/'),
        is_local_(listening_.address().is_loopback()),
        acceptor_(context_),
        check_timer_(context_),
        shortage_timer_(context_),
        finish_timer_(context_),
        hub_(context_, completed(options), std::move(events), AllowedHosts(options.address, listening_.address()),
             [this](std::function<void()> job) { get_thread_->add(std::move(job)); }) {
    url_ += hub_.options().token + '/';
    hub_.on_remove = [this] { handle_removal(); };
    acceptor_.assign(listening_.address().is_ipv4() ? tcp::v4() : tcp::v6(), listening_.release());
    wait_for_connections();
    check_times();
    const WithoutSignals without_signals;
    get_thread_ = std::make_unique<GetThread>();
    thread_ = start_thread("the thread that serves pages", [this] { run(); });
  }

  ~Implementation() {
    net::post(context_, [this] { finish(); });
    thread_.join();
    get_thread_.reset();
  }

  int port() const { return port_; }
  const std::string& url() const { return url_; }
  bool is_local() const { return is_local_; }
  const Hub& hub() const { return hub_; }

 private:
  void run() {
    // What a handler throws, for want of memory, costs its own connection, which then times out.
    for (;;) {
      try {
        context_.run();
        return;
      } catch (...) {  // NOLINT(bugprone-empty-catch)
      }
    }
  }

  void wait_for_connections() {
    if (hub_.is_finishing() || is_waiting_ || hub_.connections() >= hub_.options().max_viewers + other_connections)
      return;
    is_waiting_ = true;
    acceptor_.async_wait(tcp::acceptor::wait_read, [this](error_code error) {
      is_waiting_ = false;
      if (error || hub_.is_finishing()) return;
      if (accept_one()) {
        wait_for_connections();
      } else {
        shortage_timer_.expires_after(time_of_shortage);
        shortage_timer_.async_wait([this](error_code timer_error) {
          if (!timer_error) wait_for_connections();
        });
      }
    });
  }

  /// Returns false where there was no connection to be had for want of something.
  bool accept_one() {
    const int descriptor = ::accept4(acceptor_.native_handle(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNABORTED;
    error_code ignored;
    try {
      tcp::socket socket(context_);
      socket.assign(tcp::v4(), descriptor, ignored);
      if (ignored) {
        ::close(descriptor);
        return false;
      }
      serve(hub_, std::move(socket));
    } catch (const std::bad_alloc&) {
      return false;
    }
    return true;
  }

  void handle_removal() {
    if (!hub_.is_finishing()) return wait_for_connections();
    if (hub_.connections() == 0) context_.stop();
  }

  void check_times() {
    check_timer_.expires_after(time_between_checks);
    check_timer_.async_wait([this](error_code error) {
      if (error) return;
      check_times();
      hub_.check_times();
    });
  }

  void finish() {
    finish_timer_.expires_after(time_to_finish);
    finish_timer_.async_wait([this](error_code) { context_.stop(); });
    error_code ignored;
    acceptor_.close(ignored);
    hub_.finish();
    if (hub_.connections() == 0) context_.stop();
  }

  ListeningSocket listening_;
  int port_;
  std::string url_;
  bool is_local_;
  // What waits in the context keeps connections alive, so it is destroyed after all that they know.
  net::io_context context_{1};
  tcp::acceptor acceptor_;
  net::steady_timer check_timer_, shortage_timer_, finish_timer_;
  bool is_waiting_ = false;  ///< for a connection
  std::unique_ptr<GetThread> get_thread_;
  Hub hub_;
  std::thread thread_;
};

PageServer::PageServer(const PageServerOptions& options, PageEvents events)
    : implementation_(std::make_unique<Implementation>(options, std::move(events))) {}

PageServer::~PageServer() = default;

int PageServer::port() const { return implementation_->port(); }

std::string PageServer::url() const { return implementation_->url(); }

bool PageServer::is_local() const { return implementation_->is_local(); }

void PageServer::send_text(ViewerId viewer, std::shared_ptr<const std::string> text) {
  if (const auto found = implementation_->hub().viewer(viewer)) found->send({std::move(text), false});
}

void PageServer::send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes) {
  if (const auto found = implementation_->hub().viewer(viewer)) found->send({std::move(bytes), true});
}

size_t PageServer::queued_bytes(ViewerId viewer) const {
  const auto found = implementation_->hub().viewer(viewer);
  return found ? found->queued_bytes() : 0;
}

size_t PageServer::viewers() const { return implementation_->hub().viewers(); }

}  // namespace alhazen::impl
