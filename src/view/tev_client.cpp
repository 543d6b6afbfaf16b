#include "view/tev_client.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "util/diagnostics.h"
#include "util/parse_numbers.h"
#include "util/printable.h"
#include "util/processor_time.h"
#include "util/quoted.h"
#include "util/thread_limit.h"
#include "view/tev_packets.h"

namespace alhazen::impl {

namespace {

using Clock = std::chrono::steady_clock;

constexpr Clock::duration connect_patience = std::chrono::seconds(2), send_patience = std::chrono::seconds(10),
                          between_attempts = std::chrono::seconds(2), end_patience = std::chrono::seconds(1);
constexpr std::chrono::milliseconds poll_interval{50};

std::string message_of(int error) { return std::generic_category().message(error); }

/// A descriptor that does not block.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }

  int descriptor() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }

  /// Whether the other side has closed it. It sends nothing, so there is nothing else to be read.
  bool is_closed_by_peer() const {
    char ignored = 0;
    const ssize_t count = ::recv(descriptor_, &ignored, 1, MSG_PEEK | MSG_DONTWAIT);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
  }

 private:
  int descriptor_ = -1;
};

/// A failure of the connection, as the end of a sentence.
struct ConnectionError {
  std::string reason;
};

/// The request to end.
struct Stopped {};

struct Shown {
  std::string name;
  Image image;
};

/// Images with other names than the next one that may wait.
constexpr size_t max_waiting = 2;

}  // namespace

class TevClient::Sender {
 public:
  explicit Sender(TevAddress address) : address_(std::move(address)) {}

  // Called by the thread that owns the client.

  void show(const std::string& name, Image&& image) {
    const std::lock_guard lock(mutex_);
    const auto same =
        std::find_if(waiting_.begin(), waiting_.end(), [&](const Shown& shown) { return shown.name == name; });
    if (same != waiting_.end()) {
      same->image = std::move(image);
    } else {
      if (waiting_.size() == max_waiting) waiting_.pop_front();
      waiting_.push_back({name, std::move(image)});
    }
    changed_.notify_all();
  }

  void flush(double patience) {
    std::unique_lock lock(mutex_);
    const auto limit = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
    for (Clock::time_point since = Clock::now(); !is_idle() && Clock::now() - since < limit;) {
      changed_.wait_for(lock, poll_interval);
      since = std::max(since, progressed_);
    }
  }

  /// Asks the thread to end, and returns whether it does so soon.
  bool stop() {
    std::unique_lock lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
    return changed_.wait_for(lock, end_patience, [&] { return has_ended_; });
  }

  std::string take_problem() {
    const std::lock_guard lock(mutex_);
    return std::exchange(problem_, {});
  }

  double take_seconds() {
    const std::lock_guard lock(mutex_);
    return std::exchange(seconds_, 0);
  }

  // The thread.

  void run() noexcept {
    try {
      while (std::optional<Shown> next = wait_for_image()) {
        const double start = thread_processor_seconds();
        deliver(*next);
        next.reset();
        const std::lock_guard lock(mutex_);
        seconds_ += thread_processor_seconds() - start;
        is_sending_ = false;
        changed_.notify_all();
      }
      if (socket_.is_open()) ::shutdown(socket_.descriptor(), SHUT_WR);
      socket_ = Socket();
    } catch (const Stopped&) {
      // What remains is not sent.
    } catch (const std::exception& error) {
      report(error.what());
    }
    const std::lock_guard lock(mutex_);
    is_sending_ = false;
    is_stopped_ = has_ended_ = true;
    waiting_.clear();
    changed_.notify_all();
  }

 private:
  bool is_idle() const { return has_ended_ || (waiting_.empty() && !is_sending_); }

  std::optional<Shown> wait_for_image() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_stopped_ || !waiting_.empty(); });
    if (is_stopped_) return {};
    Shown next = std::move(waiting_.front());
    waiting_.pop_front();
    is_sending_ = true;
    return next;
  }

  bool is_stopped() const {
    const std::lock_guard lock(mutex_);
    return is_stopped_;
  }

  void report(const std::string& reason) {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(has_reported_, true)) problem_ = reason;
  }

  void has_progressed() {
    const std::lock_guard lock(mutex_);
    progressed_ = Clock::now();
  }

  /// Sends an image, by a new connection if there is none, or if tev has closed the one there was.
  void deliver(const Shown& shown) {
    if (socket_.is_open() && socket_.is_closed_by_peer()) disconnect();
    const bool was_connected = socket_.is_open();
    if (!was_connected && Clock::now() < next_attempt_) return;
    try {
      if (!was_connected) connect();
      send_image(shown);
    } catch (const ConnectionError& error) {
      disconnect();
      report("tev at " + printable(address_.to_string()) + " " + error.reason);
      next_attempt_ = Clock::now() + between_attempts;
    }
  }

  void disconnect() {
    socket_ = Socket();
    created_.reset();
  }

  void connect() {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICSERV;
    const int error = ::getaddrinfo(address_.host.c_str(), std::to_string(address_.port).c_str(), &hints, &found);
    if (error != 0)
      throw ConnectionError{std::string("is not found: ") +
                            (error == EAI_SYSTEM ? message_of(errno) : gai_strerror(error)) +
                            "; give the address by --tev HOST:PORT"};
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, ::freeaddrinfo);
    int refusal = 0;
    for (const addrinfo* one = found; one; one = one->ai_next) {
      refusal = connect_to(*one);
      if (refusal == 0) return;
    }
    throw ConnectionError{"cannot be reached: " + message_of(refusal) +
                          "; start it, and the images that follow are shown"};
  }

  /// Returns an errno value, 0 if it is connected.
  int connect_to(const addrinfo& address) {
    Socket socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, address.ai_protocol));
    if (!socket.is_open()) return errno;
    if (::connect(socket.descriptor(), address.ai_addr, address.ai_addrlen) != 0) {
      if (errno != EINPROGRESS) return errno;
      if (!wait_until_writable(socket.descriptor(), connect_patience)) return ETIMEDOUT;
      int error = 0;
      socklen_t size = sizeof(error);
      if (::getsockopt(socket.descriptor(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
      if (error != 0) return error;
    }
    const int at_once = 1;
    ::setsockopt(socket.descriptor(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    socket_ = std::move(socket);
    has_progressed();
    return 0;
  }

  /// Returns false when `patience` is over. Throws Stopped.
  bool wait_until_writable(int descriptor, Clock::duration patience) {
    const Clock::time_point end = Clock::now() + patience;
    for (;;) {
      pollfd room{descriptor, POLLOUT, 0};
      const int ready = ::poll(&room, 1, static_cast<int>(poll_interval.count()));
      if (ready > 0) return true;
      if (is_stopped()) throw Stopped();
      if (Clock::now() >= end) return false;
    }
  }

  void send_image(const Shown& shown) {
    const auto is_created = [&] {
      return created_ && created_->name == shown.name && created_->width == shown.image.width &&
             created_->height == shown.image.height && created_->channels == shown.image.channels;
    };
    if (!is_created()) {
      send(tev_create_image(shown.name, shown.image));
      created_ = Created{shown.name, shown.image.width, shown.image.height, shown.image.channels};
    }
    const int rows = tev_rows_per_packet(shown.image);
    for (int y = 0; y < shown.image.height; y += rows)
      send(tev_update_image(shown.name, shown.image, y, std::min(y + rows, shown.image.height)));
  }

  void send(const TevPacket& packet) {
    std::vector<iovec> pieces{{const_cast<char*>(packet.head.data()), packet.head.size()}};
    for (const std::span<const float> part : packet.parts)
      pieces.push_back({const_cast<float*>(part.data()), part.size_bytes()});
    for (size_t first = 0; first < pieces.size();) {
      constexpr size_t max_pieces = 64;
      msghdr message{};
      message.msg_iov = pieces.data() + first;
      message.msg_iovlen = std::min(pieces.size() - first, max_pieces);
      const ssize_t sent = ::sendmsg(socket_.descriptor(), &message, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        if (wait_until_writable(socket_.descriptor(), send_patience)) continue;
        throw ConnectionError{"reads no more: nothing more is sent on this connection"};
      }
      if (sent < 0) throw ConnectionError{"has closed the connection: " + message_of(errno)};
      has_progressed();
      for (auto left = static_cast<size_t>(sent); left > 0 || (first < pieces.size() && pieces[first].iov_len == 0);) {
        iovec& piece = pieces[first];
        const size_t taken = std::min(left, piece.iov_len);
        piece.iov_base = static_cast<char*>(piece.iov_base) + taken;
        piece.iov_len -= taken;
        left -= taken;
        if (piece.iov_len == 0) ++first;
      }
    }
  }

  /// What tev has, by the present connection.
  struct Created {
    std::string name;
    int width, height;
    std::vector<std::string> channels;
  };

  const TevAddress address_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Shown> waiting_;
  bool is_sending_ = false, is_stopped_ = false, has_ended_ = false, has_reported_ = false;
  std::string problem_;
  double seconds_ = 0;
  Clock::time_point progressed_;
  // Of the thread alone:
  Socket socket_;
  std::optional<Created> created_;
  Clock::time_point next_attempt_;
};

std::string TevAddress::to_string() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

TevAddress parse_tev_address(const std::string& text) {
  TevAddress address;
  std::string host = text, port;
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    host = text.substr(1, end == std::string::npos ? end : end - 1);
    const std::string rest = end == std::string::npos ? "" : text.substr(end + 1);
    if (end == std::string::npos || host.empty() || !(rest.empty() || rest[0] == ':'))
      throw InputError("--tev must be HOST:PORT, an IPv6 address as [::1]:14158, not " + quoted(text));
    if (!rest.empty()) port = rest;
  } else if (const size_t colon = text.find(':'); colon != std::string::npos && colon == text.rfind(':')) {
    host = text.substr(0, colon);
    port = text.substr(colon);
  }
  if (!host.empty()) address.host = host;
  const bool is_printable =
      std::none_of(host.begin(), host.end(), [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '/'; });
  if (text.empty() || !is_printable) throw InputError("--tev must be HOST:PORT, not " + quoted(text));
  if (!port.empty() && (!parse_number(port.substr(1), address.port) || address.port < 1 || address.port > 65535))
    throw InputError("the port of --tev must be a whole number from 1 to 65535, not " + quoted(port.substr(1)));
  return address;
}

TevClient::TevClient(const TevAddress& address) : sender_(std::make_shared<Sender>(address)) {
  start_thread("the thread that sends images to tev", [sender = sender_] { sender->run(); }).detach();
}

/// A look-up of a name cannot be ended, so the thread is not waited for: it keeps what it uses alive.
TevClient::~TevClient() { sender_->stop(); }

void TevClient::show(const std::string& name, Image&& image) { sender_->show(name, std::move(image)); }

void TevClient::flush(double patience) { sender_->flush(patience); }

std::string TevClient::take_problem() { return sender_->take_problem(); }

double TevClient::take_seconds() { return sender_->take_seconds(); }

}  // namespace alhazen::impl
