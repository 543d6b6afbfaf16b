#pragma once

// The values of some fields of answers.

#include <string>
#include <string_view>

namespace alhazen::impl {

/// What would end a field or begin another one is left out.
std::string without_controls(std::string_view text);

/// Content-Disposition of a download (RFC 6266), for names in UTF-8.
std::string attachment_of(std::string_view file_name);

/// Content-Security-Policy: only inline scripts and styles that have the nonce are run; what is shown and fetched comes
/// from this server, images also from the page's own data. `host` is as in a URL, or empty.
std::string content_security_policy(std::string_view nonce, std::string_view host);

/// The page's own script and style are marked by this in the place of a nonce.
inline constexpr std::string_view nonce_mark = "NONCE_OF_THIS_ANSWER";
std::string with_nonce(std::string_view html, std::string_view nonce);

}  // namespace alhazen::impl
