#include "view/server/allowed_hosts.h"

#include <unistd.h>

#include <algorithm>

namespace alhazen::impl {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string machine_name() {
  char name[256] = "";
  if (::gethostname(name, sizeof(name) - 1) != 0) return "";
  return lower(name);
}

/// Takes a port off the end. Returns whether what is left can be a host.
bool take_port(std::string_view& host) {
  const size_t bracket = host.rfind(']');
  const size_t colon = host.rfind(':');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket)) return !host.empty();
  const std::string_view port = host.substr(colon + 1);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (port.empty() || port.size() > 5 || !std::all_of(port.begin(), port.end(), is_digit)) return false;
  host = host.substr(0, colon);
  return !host.empty();
}

}  // namespace

AllowedHosts::AllowedHosts(const std::string& name, const IpAddress& listening)
    : name_(lower(name)), machine_(listening.is_loopback() ? "" : machine_name()), listening_(listening) {}

bool AllowedHosts::allows(std::string_view host) const {
  if (!take_port(host)) return false;
  std::optional<IpAddress> address;
  if (host.front() == '[') {
    if (host.back() != ']') return false;
    address = parse_ip_address(host.substr(1, host.size() - 2));
    if (!address || address->is_ipv4()) return false;
  } else if (host.find(':') == std::string_view::npos) {
    address = parse_ip_address(host);
  } else {
    return false;
  }
  if (address) return address->is_loopback() || *address == listening_ || listening_.is_wildcard();
  const std::string name = lower(host);
  if (name == "localhost" || (!name_.empty() && name == name_)) return true;
  return !machine_.empty() && (name == machine_ || name == machine_ + ".local");
}

}  // namespace alhazen::impl
