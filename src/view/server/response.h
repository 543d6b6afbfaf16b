#pragma once

// Answers of HTTP, with the fields that browsers keep to.

#include <string>
#include <string_view>
#include <utility>

#include "view/page_server.h"
#include "view/server/asio.h"
#include "view/server/header_text.h"
#include "view/server/token.h"

namespace alhazen::impl {

struct HttpAnswer {
  PageResponse response;
  std::string location;  ///< of a redirection
  std::string nonce;     ///< that scripts and styles must have to be run; empty: none are
};

inline HttpAnswer page_answer() {
  HttpAnswer answer{.response = {}, .location = {}, .nonce = random_token()};
  answer.response.content_type = "text/html; charset=utf-8";
  answer.response.body = with_nonce(page_html(), answer.nonce);
  return answer;
}

/// Without the '/' at the end, what the page asks for would not be below it.
inline HttpAnswer redirection_to_page(std::string_view token) {
  HttpAnswer answer{.response = {}, .location = '/' + std::string(token) + '/', .nonce = {}};
  answer.response.status = 308;
  answer.response.body = "The page is at " + answer.location + '\n';
  return answer;
}

/// `host` is the field Host of the request, once it has been checked; before, it is empty.
inline http::response<http::string_body> make_http_response(HttpAnswer answer, std::string_view host) {
  PageResponse& page = answer.response;
  http::response<http::string_body> response(static_cast<http::status>(page.status), 11);
  response.set(http::field::content_type, without_controls(page.content_type));
  response.set(http::field::cache_control, "no-store");
  response.set(http::field::x_frame_options, "DENY");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Content-Security-Policy", content_security_policy(answer.nonce, host));
  if (!page.file_name.empty()) response.set(http::field::content_disposition, attachment_of(page.file_name));
  if (!answer.location.empty()) response.set(http::field::location, answer.location);
  if (page.status == 405) response.set(http::field::allow, "GET");
  if (page.status == 426) response.set(http::field::upgrade, "websocket");
  response.body() = std::move(page.body);
  response.prepare_payload();
  // Each connection takes one request; the page takes few, and messages go another way.
  response.set(http::field::connection, page.status == 426 ? "upgrade, close" : "close");
  return response;
}

}  // namespace alhazen::impl
