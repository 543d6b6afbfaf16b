#pragma once

// A client of the server of pages: WebSocket (RFC 6455) over a blocking socket of this machine, as far as tests need
// it.

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace alhazen::impl::test {

/// Of "http://127.0.0.1:PORT/TOKEN/".
struct PageAddress {
  int port = 0;
  std::string token;
};

inline PageAddress page_address(const std::string& text) {
  const std::string begin = "http://127.0.0.1:";
  const size_t at = text.find(begin);
  if (at == std::string::npos) throw std::runtime_error("no address in: " + text);
  const size_t slash = text.find('/', at + begin.size()), end = text.find('/', slash + 1);
  return {std::stoi(text.substr(at + begin.size())), text.substr(slash + 1, end - slash - 1)};
}

class WebSocket {
 public:
  struct Message {
    bool is_binary = false;
    std::string payload;
  };

  explicit WebSocket(const PageAddress& page) {
    connect(page.port);
    const std::string host = "127.0.0.1:" + std::to_string(page.port);
    send_all("GET /" + page.token + "/socket HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
             "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
             "Sec-WebSocket-Version: 13\r\n\r\n");
    while (received_.find("\r\n\r\n") == std::string::npos)
      if (!receive_more()) throw std::runtime_error("no answer: " + received_);
    if (received_.find("HTTP/1.1 101") != 0) throw std::runtime_error("refused: " + received_);
    received_.erase(0, received_.find("\r\n\r\n") + 4);
  }
  ~WebSocket() { ::close(socket_); }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// Clients mask what they send; a mask of zeros is one.
  void send(const std::string& text) {
    std::string frame = "\x81";
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      frame += static_cast<char>(0x80 | 126);
      frame += static_cast<char>(text.size() >> 8);
      frame += static_cast<char>(text.size() & 255);
    }
    send_all(frame + std::string(4, '\0') + text);
  }

  /// The next message; nothing if the connection is closed, or nothing comes for ten seconds.
  std::optional<Message> receive() {
    Message message;
    for (;;) {
      const size_t length = head_size();
      if (length == 0 || received_.size() < length + payload_size_) {
        if (!receive_more()) return {};
        continue;
      }
      const auto first = static_cast<uint8_t>(received_[0]);
      const int kind = first & 15;
      const std::string payload = received_.substr(length, payload_size_);
      received_.erase(0, length + payload_size_);
      if (kind == 8) return {};
      if (kind == 9 || kind == 10) continue;  // pings are not answered: tests are shorter than the patience
      if (kind == 2) message.is_binary = true;
      message.payload += payload;
      if (first & 0x80) return message;
    }
  }

 private:
  void connect(int port) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(port));
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0)
      throw std::runtime_error("no connection");
  }

  void send_all(const std::string& bytes) {
    for (size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return;  // it is closed, which receive says
      sent += static_cast<size_t>(count);
    }
  }

  bool receive_more() {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, 10'000) <= 0) return false;
    char buffer[1 << 16];
    const ssize_t count = ::recv(socket_, buffer, sizeof(buffer), 0);
    if (count <= 0) return false;
    received_.append(buffer, static_cast<size_t>(count));
    return true;
  }

  /// Of the next frame, and sets the size of its payload; 0: it is not there yet.
  size_t head_size() {
    if (received_.size() < 2) return 0;
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(received_[i]); };
    payload_size_ = byte(1);
    const size_t extra = payload_size_ == 126 ? 2 : payload_size_ == 127 ? 8 : 0;
    if (received_.size() < 2 + extra) return 0;
    if (extra > 0) payload_size_ = 0;
    for (size_t i = 0; i < extra; ++i) payload_size_ = payload_size_ << 8 | byte(2 + i);
    return 2 + extra;
  }

  int socket_ = -1;
  std::string received_;
  size_t payload_size_ = 0;
};

}  // namespace alhazen::impl::test
