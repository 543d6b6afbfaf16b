#include "view/server/request_target.h"

#include <algorithm>
#include <string_view>

namespace alhazen::impl {

namespace {

bool is_of_paths(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         std::string_view("._~/-").find(c) != std::string_view::npos;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

std::optional<RequestTarget> parse_request_target(std::string_view target) {
  if (target.empty() || target[0] != '/') return std::nullopt;
  RequestTarget result;
  const size_t question = target.find('?');
  if (question != std::string_view::npos) result.query = target.substr(question + 1);
  const std::string_view whole = target.substr(1, question == std::string_view::npos ? question : question - 1);
  if (!std::all_of(whole.begin(), whole.end(), is_of_paths)) return std::nullopt;
  const size_t slash = whole.find('/');
  result.token = whole.substr(0, slash);
  result.has_folder = slash != std::string_view::npos;
  if (result.has_folder) result.path = whole.substr(slash + 1);
  return result;
}

bool is_same_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view scheme = "http://";
  if (origin.size() != scheme.size() + host.size()) return false;
  const auto equal = [](char a, char b) { return lower(a) == lower(b); };
  return std::equal(scheme.begin(), scheme.end(), origin.begin(), equal) &&
         std::equal(host.begin(), host.end(), origin.begin() + static_cast<std::ptrdiff_t>(scheme.size()), equal);
}

}  // namespace alhazen::impl
