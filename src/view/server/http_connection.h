#pragma once

// A connection that has sent no request yet, or one that is answered by HTTP. It takes one request and ends; or it
// becomes a viewer.

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "view/server/hub.h"
#include "view/server/request_target.h"
#include "view/server/response.h"
#include "view/server/token.h"
#include "view/server/viewer.h"

namespace alhazen::impl {

class HttpConnection final : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Hub& hub, tcp::socket socket) : hub_(hub), socket_(std::move(socket)) {}

  void start();

  void check_time(ServerClock::time_point now) override;
  void finish() override;
  void drop() override { end(); }

 private:
  static constexpr size_t max_header_bytes = size_t{8} << 10;
  static constexpr auto request_time = std::chrono::seconds(10);   ///< for all of a request
  static constexpr auto response_time = std::chrono::seconds(20);  ///< for any part of a response
  static constexpr auto linger_time = std::chrono::seconds(2);     ///< for the other side to close

  enum class State { receiving, computing, sending, lingering };

  void handle_request(error_code error);
  void answer();
  void open_viewer();
  void refuse(int status, const std::string& sentence);
  void respond(HttpAnswer answer);
  void send();
  void linger();
  void end();

  Hub& hub_;
  tcp::socket socket_;
  beast::flat_buffer received_{max_header_bytes};
  http::request_parser<http::empty_body> parser_;
  std::optional<http::response<http::string_body>> response_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
  State state_ = State::receiving;
  ServerClock::time_point since_ = ServerClock::now();  ///< of the state or, while it sends, of the last progress
  bool has_ended_ = false;
};

/// A connection that was accepted.
inline void serve(Hub& hub, tcp::socket socket) {
  error_code ignored;
  // Small messages go at once, and a network that is gone is noticed in time, also while nothing can be sent.
  socket.set_option(tcp::no_delay(true), ignored);
  constexpr unsigned milliseconds = 45'000;
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &milliseconds, sizeof(milliseconds));
  const auto connection = std::make_shared<HttpConnection>(hub, std::move(socket));
  hub.add(connection);
  connection->start();
}

inline void HttpConnection::start() {
  parser_.header_limit(max_header_bytes);
  http::async_read_header(socket_, received_, parser_,
                          [self = shared_from_this()](error_code error, size_t) { self->handle_request(error); });
}

inline void HttpConnection::handle_request(error_code error) {
  if (has_ended_) return;
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return refuse(431, "The header of this request is too long.");
  // Of a connection that was closed or broken nobody reads the answer.
  if (error == http::error::end_of_stream || error == http::error::partial_message ||
      (error && error.category() != http::make_error_code(http::error::bad_method).category()))
    return end();
  if (error) return refuse(400, "This is no request of HTTP.");
  answer();
}

inline void HttpConnection::answer() {
  const auto& request = parser_.get();
  const auto text = [](beast::string_view view) { return std::string_view(view.data(), view.size()); };
  if (request.count(http::field::host) != 1) return refuse(400, "This request does not say once which host it is for.");
  if (!hub_.hosts().allows(text(request[http::field::host])))
    return refuse(403, "This server is not known by this name: use the address that the program has printed.");
  const auto target = parse_request_target(text(request.target()));
  if (!target || !equal_tokens(target->token, hub_.options().token))
    return refuse(403, "This address lacks the right token: use the one that the program has printed.");
  if (request.method() != http::verb::get) return refuse(405, "Only GET is answered.");
  if (parser_.chunked() || parser_.content_length().value_or(0) > 0)
    return refuse(413, "This request must have no body.");
  if (!target->has_folder) return respond(redirection_to_page(target->token));
  if (target->path.empty()) return respond(page_answer());
  if (target->path == "socket") return open_viewer();
  state_ = State::computing;
  hub_.run_slowly(
      [self = shared_from_this(), path = std::string(target->path), query = std::string(target->query)]() mutable {
        PageResponse response = self->hub_.get(path, query);
        Hub& hub = self->hub_;
        // `self` is moved, so that it is destroyed on the server's thread.
        net::post(hub.context(), [self = std::move(self), response = std::move(response)]() mutable {
          self->respond({.response = std::move(response), .location = {}, .nonce = {}});
        });
      });
}

inline void HttpConnection::open_viewer() {
  const auto& request = parser_.get();
  const auto text = [](beast::string_view view) { return std::string_view(view.data(), view.size()); };
  if (!websocket::is_upgrade(request)) return refuse(426, "This address is for WebSocket.");
  // Programs that are no browsers send no origin, and no page of another site can make them ask.
  for (const auto& field : request)
    if (field.name() == http::field::origin && !is_same_origin(text(field.value()), text(request[http::field::host])))
      return refuse(403, "A page of another site asks for this.");
  if (received_.size() > 0) return refuse(400, "Data came before the connection was open.");
  auto slot = hub_.reserve_viewer();
  if (!slot)
    return refuse(503, "There are " + std::to_string(hub_.options().max_viewers) +
                           " viewers already, and no more are let in: close one of them.");
  const auto viewer = std::make_shared<Viewer>(hub_, std::move(socket_), std::move(slot));
  hub_.add(viewer);
  viewer->accept(request);
  end();
}

inline void HttpConnection::refuse(int status, const std::string& sentence) {
  respond({.response = Hub::failure(status, sentence), .location = {}, .nonce = {}});
}

inline void HttpConnection::respond(HttpAnswer answer) {
  if (has_ended_) return;
  const auto host = parser_.is_header_done() ? parser_.get()[http::field::host] : beast::string_view();
  response_ = make_http_response(std::move(answer), {host.data(), host.size()});
  serializer_.emplace(*response_);
  state_ = State::sending;
  since_ = ServerClock::now();
  send();
}

inline void HttpConnection::send() {
  http::async_write_some(socket_, *serializer_, [self = shared_from_this()](error_code error, size_t) {
    if (self->has_ended_) return;
    if (error) return self->end();
    self->since_ = ServerClock::now();
    if (self->serializer_->is_done()) {
      self->linger();
    } else {
      self->send();
    }
  });
}

inline void HttpConnection::linger() {
  // A connection that is closed while something it was sent is unread discards its answer (RFC 9112, section 9.6).
  if (state_ != State::lingering) {
    state_ = State::lingering;
    since_ = ServerClock::now();
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    serializer_.reset();
    response_.reset();
  }
  received_.clear();
  socket_.async_read_some(received_.prepare(max_header_bytes), [self = shared_from_this()](error_code error, size_t) {
    if (error || self->has_ended_) return self->end();
    self->linger();
  });
}

inline void HttpConnection::check_time(ServerClock::time_point now) {
  if (state_ == State::computing) return;
  const auto limit = state_ == State::receiving ? request_time : state_ == State::sending ? response_time : linger_time;
  if (now - since_ > limit) end();
}

inline void HttpConnection::finish() {
  if (state_ != State::sending) end();
}

inline void HttpConnection::end() {
  if (std::exchange(has_ended_, true)) return;
  const auto self = shared_from_this();
  error_code ignored;
  socket_.close(ignored);
  hub_.remove(this);
}

}  // namespace alhazen::impl
