#pragma once

// A page that is connected by WebSocket.

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "view/server/hub.h"
#include "view/server/outbox.h"

namespace alhazen::impl {

class Viewer final : public Connection, public std::enable_shared_from_this<Viewer> {
 public:
  /// `slot` is that of Hub::reserve_viewer.
  Viewer(Hub& hub, tcp::socket socket, std::shared_ptr<void> slot)
      : hub_(hub),
        socket_(std::move(socket)),
        slot_(std::move(slot)),
        id_(hub.next_id()),
        outbox_(hub.options().max_queued_bytes) {}

  /// Answers the request to open the connection.
  void accept(const http::request<http::empty_body>& request);

  void send(OutgoingMessage message);  ///< from any thread
  size_t queued_bytes() const { return outbox_.bytes(); }

  void check_time(ServerClock::time_point now) override;
  void finish() override;
  void drop() override;

 private:
  static constexpr size_t max_message_bytes = size_t{1} << 20;
  /// Messages are sent in frames of at most this size: pings and answers to them go between these, and each that has
  /// gone shows that the viewer still reads.
  static constexpr size_t frame_bytes = size_t{256} << 10;
  static constexpr auto handshake_time = std::chrono::seconds(10);
  static constexpr auto ping_after = std::chrono::seconds(20);
  static constexpr auto silence_time = std::chrono::seconds(45);

  void read();
  void send_next();
  void send_frame();
  void close(websocket::close_code code, std::string_view reason);
  void end();

  Hub& hub_;
  websocket::stream<tcp::socket> socket_;
  std::shared_ptr<void> slot_;
  const ViewerId id_;
  Outbox outbox_;
  beast::flat_buffer received_{max_message_bytes};
  OutgoingMessage sending_;
  size_t sent_bytes_ = 0;
  ServerClock::time_point alive_ = ServerClock::now();  ///< when it was heard of, or took a frame
  bool is_open_ = false;
  bool is_sending_ = false;
  bool is_pinging_ = false;
  bool is_finishing_ = false;
  bool is_closing_ = false;
  bool has_ended_ = false;
};

inline void Viewer::accept(const http::request<http::empty_body>& request) {
  // The silence of viewers is looked after here: Beast's own timeout does not see that a large message is on its way.
  socket_.set_option(
      websocket::stream_base::timeout{websocket::stream_base::none(), websocket::stream_base::none(), false});
  socket_.read_message_max(max_message_bytes);
  socket_.auto_fragment(false);
  socket_.control_callback([this](websocket::frame_type, beast::string_view) { alive_ = ServerClock::now(); });
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error || self->has_ended_) return self->end();
    self->alive_ = ServerClock::now();
    self->is_open_ = true;
    self->hub_.opened(self->id_, self);
    self->read();
    if (self->is_finishing_) self->finish();
  });
}

inline void Viewer::read() {
  socket_.async_read(received_, [self = shared_from_this()](error_code error, size_t) {
    if (error || self->has_ended_) return self->end();
    self->alive_ = ServerClock::now();
    if (!self->socket_.got_text()) return self->close(websocket::close_code::unknown_data, "messages are text");
    const auto data = self->received_.cdata();
    self->hub_.message(self->id_, {static_cast<const char*>(data.data()), data.size()});
    self->received_.clear();
    constexpr size_t usual_bytes = size_t{64} << 10;
    if (self->received_.capacity() > usual_bytes) self->received_.shrink_to_fit();
    self->read();
  });
}

inline void Viewer::send(OutgoingMessage message) {
  if (!outbox_.push(std::move(message))) return;
  net::post(hub_.context(), [self = shared_from_this()] {
    if (self->outbox_.has_overflowed()) return self->drop();
    self->send_next();
  });
}

inline void Viewer::send_next() {
  if (is_sending_ || is_closing_ || has_ended_) return;
  auto message = outbox_.take();
  if (!message) {
    if (is_finishing_) close(websocket::close_code::going_away, "the program ends");
    return;
  }
  is_sending_ = true;
  sending_ = std::move(*message);
  sent_bytes_ = 0;
  socket_.binary(sending_.is_binary);
  send_frame();
}

inline void Viewer::send_frame() {
  const size_t size = std::min(sending_.bytes->size() - sent_bytes_, frame_bytes);
  const bool is_last = sent_bytes_ + size == sending_.bytes->size();
  socket_.async_write_some(is_last, net::buffer(sending_.bytes->data() + sent_bytes_, size),
                           [self = shared_from_this(), size, is_last](error_code error, size_t) {
                             if (error || self->has_ended_) return self->end();
                             self->alive_ = ServerClock::now();
                             self->sent_bytes_ += size;
                             if (!is_last) return self->send_frame();
                             self->is_sending_ = false;
                             self->sending_ = {};
                             self->outbox_.sent();
                             self->send_next();
                           });
}

inline void Viewer::close(websocket::close_code code, std::string_view reason) {
  if (is_closing_ || has_ended_) return;
  is_closing_ = true;
  alive_ = ServerClock::now();
  socket_.async_close({code, beast::string_view(reason.data(), reason.size())},
                      [self = shared_from_this()](error_code) { self->end(); });
}

inline void Viewer::check_time(ServerClock::time_point now) {
  const auto silence = now - alive_;
  if (silence > (is_open_ && !is_closing_ ? silence_time : handshake_time)) return drop();
  if (!is_open_ || is_closing_ || is_pinging_ || silence < ping_after) return;
  is_pinging_ = true;
  socket_.async_ping({}, [self = shared_from_this()](error_code error) {
    self->is_pinging_ = false;
    if (error) self->end();
  });
}

inline void Viewer::finish() {
  is_finishing_ = true;
  if (is_open_) send_next();
}

inline void Viewer::drop() {
  // Discards what the system still holds for it.
  error_code ignored;
  socket_.next_layer().set_option(net::socket_base::linger(true, 0), ignored);
  end();
}

inline void Viewer::end() {
  if (std::exchange(has_ended_, true)) return;
  const auto self = shared_from_this();
  outbox_.close();
  error_code ignored;
  socket_.next_layer().close(ignored);
  slot_.reset();
  if (is_open_) hub_.closed(id_);
  hub_.remove(this);
}

}  // namespace alhazen::impl
