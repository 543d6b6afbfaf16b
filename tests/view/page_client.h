#pragma once

// A client of PageServer which can also say what no browser would: the bytes of HTTP and WebSocket by hand.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace alhazen::impl {

enum FrameKind : unsigned {
  continuation_frame = 0,
  text_frame = 1,
  binary_frame = 2,
  close_frame = 8,
  ping_frame = 9,
  pong_frame = 10
};

struct ReceivedFrame {
  unsigned kind = 0;
  bool is_last = true;
  std::string payload;

  int close_code() const {
    if (kind != close_frame || payload.size() < 2) return 0;
    return static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
  }
};

class PageClient {
 public:
  PageClient() : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
  explicit PageClient(int port) : PageClient() { connect(port); }
  PageClient(PageClient&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), received_(std::move(other.received_)) {}
  PageClient& operator=(PageClient&&) = delete;
  ~PageClient() { close(); }

  bool connect(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }

  void close() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }
  void end_sending() const { ::shutdown(descriptor_, SHUT_WR); }
  int descriptor() const { return descriptor_; }

  /// Returns false if the server has closed the connection.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<size_t>(sent));
    }
    return true;
  }

  /// Waits for more. Returns false at the end of the connection, or if nothing comes in time.
  bool receive(std::chrono::milliseconds time = std::chrono::seconds(20)) {
    pollfd waiting{descriptor_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(time.count())) != 1) return false;
    char bytes[65536];
    const ssize_t count = ::recv(descriptor_, bytes, sizeof(bytes), 0);
    if (count <= 0) {
      has_ended_ = true;
      return false;
    }
    received_.append(bytes, static_cast<size_t>(count));
    return true;
  }

  /// All until the server ends the connection, which it must do.
  std::string receive_all() {
    while (receive()) {
    }
    return has_ended_ ? std::exchange(received_, {}) : "the connection does not end";
  }

  bool has_ended() const { return has_ended_; }

  /// Asks for a WebSocket. Returns the answer's header.
  std::string open(const std::string& token, const std::string& fields = "Host: localhost\r\n") {
    send("GET /" + token + "/socket HTTP/1.1\r\n" + fields +
         "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Version: 13\r\n\r\n");
    while (received_.find("\r\n\r\n") == std::string::npos && receive()) {
    }
    const size_t end = received_.find("\r\n\r\n");
    if (end == std::string::npos) return received_;
    const std::string header = received_.substr(0, end + 2);
    received_.erase(0, end + 4);
    return header;
  }

  /// `first_byte` is that of RFC 6455: 0x80 the last frame of a message, 0x70 reserved, and its kind.
  static std::string frame(unsigned first_byte, std::string_view payload, bool is_masked = true) {
    std::string bytes(1, static_cast<char>(first_byte));
    const unsigned mask_bit = is_masked ? 0x80 : 0;
    const size_t size = payload.size();
    int size_bytes = 0;
    if (size < 126) {
      bytes += static_cast<char>(mask_bit | size);
    } else if (size < 65536) {
      bytes += static_cast<char>(mask_bit | 126);
      size_bytes = 2;
    } else {
      bytes += static_cast<char>(mask_bit | 127);
      size_bytes = 8;
    }
    for (int i = size_bytes - 1; i >= 0; --i) bytes += static_cast<char>(size >> (8 * i));
    if (!is_masked) return bytes.append(payload);
    const char mask[] = {0x12, 0x34, 0x56, 0x78};
    bytes.append(mask, 4);
    for (size_t i = 0; i < size; ++i) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
    return bytes;
  }

  bool send_text(std::string_view text) const { return send(frame(0x80 | text_frame, text)); }

  /// Nothing at the end of the connection.
  std::optional<ReceivedFrame> receive_frame() {
    const auto need = [&](size_t count) {
      while (received_.size() < count)
        if (!receive()) return false;
      return true;
    };
    if (!need(2)) return std::nullopt;
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(received_[i]); };
    size_t header = 2, size = byte(1) & 127;
    if (size >= 126) {
      const size_t count = size == 126 ? 2 : 8;
      if (!need(2 + count)) return std::nullopt;
      size = 0;
      for (size_t i = 0; i < count; ++i) size = size << 8 | byte(2 + i);
      header += count;
    }
    if (!need(header + size)) return std::nullopt;
    ReceivedFrame frame{byte(0) & 15u, (byte(0) & 0x80) != 0, received_.substr(header, size)};
    received_.erase(0, header + size);
    return frame;
  }

  /// The next whole message. Pings are answered; nothing at the end of the connection.
  std::optional<std::string> receive_message() {
    std::string message;
    while (auto part = receive_frame()) {
      if (part->kind == close_frame) return std::nullopt;
      if (part->kind == ping_frame) send(frame(0x80 | pong_frame, part->payload));
      if (part->kind >= close_frame) continue;
      message += part->payload;
      if (part->is_last) return message;
    }
    return std::nullopt;
  }

 private:
  int descriptor_;
  std::string received_;
  bool has_ended_ = false;
};

struct HttpAnswerText {
  int status = 0;
  std::string header, body;
};

/// Sends `request` and reads the whole answer; status 0 if there is none.
inline HttpAnswerText ask(int port, const std::string& request) {
  PageClient client(port);
  client.send(request);
  const std::string all = client.receive_all();
  HttpAnswerText answer;
  const size_t end = all.find("\r\n\r\n");
  if (all.rfind("HTTP/1.1 ", 0) != 0 || end == std::string::npos) return answer;
  answer.status = std::stoi(all.substr(9, 3));
  answer.header = all.substr(0, end + 2);
  answer.body = all.substr(end + 4);
  return answer;
}

inline HttpAnswerText get(int port, const std::string& target, const std::string& fields = "Host: localhost\r\n") {
  return ask(port, "GET " + target + " HTTP/1.1\r\n" + fields + "\r\n");
}

}  // namespace alhazen::impl
