#include "view/server/header_text.h"

namespace alhazen::impl {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         std::string_view("-._").find(c) != std::string_view::npos;
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (!is_control(c)) result += c;
  return result;
}

std::string attachment_of(std::string_view file_name) {
  // The first name is for browsers that do not know the second one.
  std::string ascii, utf8;
  for (const char c : file_name) {
    ascii += is_plain(c) || c == ' ' ? c : '_';
    if (is_plain(c)) {
      utf8 += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      utf8 += {'%', "0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
    }
  }
  return "attachment; filename=\"" + ascii + "\"; filename*=UTF-8''" + utf8;
}

std::string content_security_policy(std::string_view nonce, std::string_view host) {
  const std::string own = nonce.empty() ? "'none'" : "'nonce-" + std::string(nonce) + '\'';
  // Older browsers do not count WebSockets of the same host as 'self'.
  const std::string sockets = host.empty() ? "" : " ws://" + std::string(host);
  return "default-src 'none'; script-src " + own + "; style-src " + own +
         "; img-src 'self' blob: data:; connect-src 'self'" + sockets +
         "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

std::string with_nonce(std::string_view html, std::string_view nonce) {
  std::string result;
  result.reserve(html.size() + 64);
  for (;;) {
    const size_t mark = html.find(nonce_mark);
    result += html.substr(0, mark);
    if (mark == std::string_view::npos) return result;
    result += nonce;
    html.remove_prefix(mark + nonce_mark.size());
  }
}

}  // namespace alhazen::impl
