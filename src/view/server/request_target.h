#pragma once

// What a request asks for.

#include <optional>
#include <string_view>

namespace alhazen::impl {

/// "/TOKEN/save.exr?exposure=1". Views of the text that it was made from.
struct RequestTarget {
  std::string_view token;
  std::string_view path;   ///< "save.exr"; empty: the page
  std::string_view query;  ///< "exposure=1"
  bool has_folder = true;  ///< false: "/TOKEN", from where the page's own addresses would not be found
};

/// Nothing for what is no path: other forms of RFC 9112, section 3.2, or one with characters beside those that the
/// page uses (letters, digits and "._~/-").
std::optional<RequestTarget> parse_request_target(std::string_view target);

/// Whether `origin` is that of a page that was loaded from `host`, a request's field Host. So a page of another site
/// that the same browser shows is refused, for browsers send the origin with each WebSocket that a page opens.
bool is_same_origin(std::string_view origin, std::string_view host);

}  // namespace alhazen::impl
