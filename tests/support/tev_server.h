#pragma once

// A server that understands what tev does: it takes packets as the protocol describes them, refuses all that it does
// not describe, and keeps the images.

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "images/image.h"

namespace alhazen::impl::test {

/// Reads the numbers and texts of a packet; throws std::runtime_error beyond its end.
class TevReader {
 public:
  explicit TevReader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    if (left() < sizeof(value)) throw std::runtime_error("a packet that is too short");
    std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
    return value;
  }

  bool flag() {
    const auto value = number<uint8_t>();
    if (value > 1) throw std::runtime_error("a flag that is neither 0 nor 1");
    return value == 1;
  }

  std::string text() {
    const size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) throw std::runtime_error("a text without an end");
    const std::string value(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return value;
  }

  std::vector<std::string> texts(int count) {
    std::vector<std::string> values;
    for (int i = 0; i < count; ++i) values.push_back(text());
    return values;
  }

  size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
};

/// What tev holds after packets.
class TevImages {
 public:
  /// A whole packet, with its length. Throws std::runtime_error where tev would refuse it, or ignore it.
  void take(std::string_view packet) {
    TevReader reader(packet);
    if (reader.number<uint32_t>() != packet.size()) throw std::runtime_error("a packet of another length");
    switch (const int kind = reader.number<uint8_t>()) {
      case 4:
        return create(reader);
      case 6:
        return update(reader);
      default:
        throw std::runtime_error("a packet of kind " + std::to_string(kind));
    }
  }

  std::map<std::string, Image> images;
  std::map<std::string, int> created, finished;  ///< by name: how often it was made, and its last row was sent
  std::string selected;

 private:
  void create(TevReader& reader) {
    const bool selects = reader.flag();
    const std::string name = reader.text();
    Image image;
    image.width = reader.number<int32_t>();
    image.height = reader.number<int32_t>();
    const int count = reader.number<int32_t>();
    if (image.width < 1 || image.height < 1 || count < 1) throw std::runtime_error("an image without pixels");
    image.channels = reader.texts(count);
    if (reader.left() != 0) throw std::runtime_error("a packet with more than an image");
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    image.planes.assign(image.channels.size(), std::vector<float>(pixels));
    images[name] = std::move(image);
    ++created[name];
    if (selects) selected = name;
  }

  void update(TevReader& reader) {
    if (reader.flag()) throw std::runtime_error("an update that changes what the user looks at");
    const std::string name = reader.text();
    const int count = reader.number<int32_t>();
    if (count < 1) throw std::runtime_error("an update without channels");
    const std::vector<std::string> channels = reader.texts(count);
    const int x0 = reader.number<int32_t>(), y0 = reader.number<int32_t>();
    const int width = reader.number<int32_t>(), height = reader.number<int32_t>();
    const auto found = images.find(name);
    if (found == images.end()) throw std::runtime_error("an update of an image that there is not");
    Image& image = found->second;
    if (x0 < 0 || y0 < 0 || width < 1 || height < 1 || x0 + width > image.width || y0 + height > image.height)
      throw std::runtime_error("an update outside of its image");
    std::vector<int64_t> offsets, strides;
    for (int c = 0; c < count; ++c) offsets.push_back(reader.number<int64_t>());
    for (int c = 0; c < count; ++c) strides.push_back(reader.number<int64_t>());
    const int64_t pixels = int64_t{width} * height;
    int64_t needed = 0;
    for (size_t c = 0; c < channels.size(); ++c) needed = std::max(needed, offsets[c] + (pixels - 1) * strides[c] + 1);
    if (reader.left() != static_cast<size_t>(needed) * sizeof(float))
      throw std::runtime_error("an update with another number of values");
    std::vector<float> values(static_cast<size_t>(needed));
    for (float& value : values) value = reader.number<float>();
    for (size_t c = 0; c < channels.size(); ++c) {
      const int plane = image.channel(channels[c]);
      if (plane < 0) throw std::runtime_error("an update of a channel that there is not");
      for (int64_t i = 0; i < pixels; ++i) {
        const int64_t x = x0 + i % width, y = y0 + i / width;
        image.planes[static_cast<size_t>(plane)][static_cast<size_t>(y * image.width + x)] =
            values.at(static_cast<size_t>(offsets[c] + i * strides[c]));
      }
    }
    if (y0 + height == image.height) ++finished[name];
  }
};

/// Listens on a free port of this machine, and serves one connection after another on its own thread.
class TevServer {
 public:
  struct Behaviour {
    size_t closes_after = SIZE_MAX;  ///< bytes of a connection
    bool reads = true;
    bool is_ipv6 = false;
  };

  explicit TevServer(Behaviour behaviour) : behaviour_(behaviour) {
    listener_ = ::socket(behaviour.is_ipv6 ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in6 six{};
    six.sin6_family = AF_INET6;
    six.sin6_addr = in6addr_loopback;
    sockaddr_in four{};
    four.sin_family = AF_INET;
    four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool is_six = behaviour.is_ipv6;
    const auto* address = is_six ? reinterpret_cast<sockaddr*>(&six) : reinterpret_cast<sockaddr*>(&four);
    if (::bind(listener_, address, is_six ? sizeof(six) : sizeof(four)) != 0 || ::listen(listener_, 5) != 0)
      throw std::runtime_error("no port");
    sockaddr_in6 bound{};
    socklen_t size = sizeof(bound);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&bound), &size);
    port_ = ntohs(is_six ? bound.sin6_port : reinterpret_cast<sockaddr_in*>(&bound)->sin_port);
    thread_ = std::thread([this] { run(); });
  }
  TevServer() : TevServer(Behaviour{}) {}

  ~TevServer() {
    stop();
    ::close(listener_);
  }
  TevServer(const TevServer&) = delete;
  TevServer& operator=(const TevServer&) = delete;

  int port() const { return port_; }
  std::string address() const { return (behaviour_.is_ipv6 ? "[::1]:" : "127.0.0.1:") + std::to_string(port_); }
  int connections() const { return connections_; }

  /// Calls `use` with what there is now. Refused packets fail the test.
  void with_images(const std::function<void(const TevImages&)>& use) {
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(refused_, "");
    use(images_);
  }

  /// Until the client has closed its connection, or for a second.
  void wait_for_end() {
    for (int i = 0; i < 100 && (connections_ == 0 || is_serving_); ++i) ::usleep(10'000);
  }

  void stop() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  static bool is_ready(int descriptor) {
    pollfd ready{descriptor, POLLIN, 0};
    return ::poll(&ready, 1, 10) > 0;
  }

  void run() {
    while (!is_over_) {
      if (!is_ready(listener_)) continue;
      const int client = ::accept(listener_, nullptr, nullptr);
      if (client < 0) continue;
      is_serving_ = true;
      ++connections_;
      serve(client);
      ::close(client);
      is_serving_ = false;
    }
  }

  void serve(int client) {
    std::string bytes;
    size_t received = 0;
    while (!is_over_) {
      if (!behaviour_.reads || !is_ready(client)) {
        if (!behaviour_.reads) ::usleep(10'000);
        continue;
      }
      char buffer[1 << 16];
      const ssize_t count = ::recv(client, buffer, sizeof(buffer), 0);
      if (count <= 0) {
        const std::lock_guard lock(mutex_);
        if (!bytes.empty() && count == 0) refused_ = "a connection that ends within a packet";
        return;
      }
      received += static_cast<size_t>(count);
      if (received > behaviour_.closes_after) return;
      bytes.append(buffer, static_cast<size_t>(count));
      if (!take_packets(bytes)) return;
    }
  }

  bool take_packets(std::string& bytes) {
    const std::lock_guard lock(mutex_);
    uint32_t length = 0;
    size_t done = 0;
    while (bytes.size() - done >= sizeof(length)) {
      std::memcpy(&length, bytes.data() + done, sizeof(length));
      if (bytes.size() - done < length) break;
      try {
        images_.take(std::string_view(bytes).substr(done, length));
      } catch (const std::exception& error) {
        refused_ = error.what();
        return false;
      }
      done += length;
    }
    bytes.erase(0, done);
    return true;
  }

  Behaviour behaviour_;
  int listener_ = -1, port_ = 0;
  std::atomic<bool> is_over_{false}, is_serving_{false};
  std::atomic<int> connections_{0};
  std::mutex mutex_;
  TevImages images_;
  std::string refused_;
  std::thread thread_;
};

}  // namespace alhazen::impl::test
