#include "view/server/ip_address.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstring>

namespace alhazen::impl {

namespace {

constexpr std::array<unsigned char, 12> ipv4_prefix = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

IpAddress from_ipv4(const in_addr& address) {
  IpAddress result;
  std::copy(ipv4_prefix.begin(), ipv4_prefix.end(), result.bytes.begin());
  std::memcpy(result.bytes.data() + ipv4_prefix.size(), &address, sizeof(address));
  return result;
}

IpAddress from_ipv6(const in6_addr& address) {
  IpAddress result;
  std::memcpy(result.bytes.data(), &address, sizeof(address));
  return result;
}

}  // namespace

bool IpAddress::is_ipv4() const { return std::equal(ipv4_prefix.begin(), ipv4_prefix.end(), bytes.begin()); }

bool IpAddress::is_loopback() const { return is_ipv4() ? bytes[12] == 127 : *this == from_ipv6(in6addr_loopback); }

bool IpAddress::is_wildcard() const { return *this == from_ipv6(in6addr_any) || *this == from_ipv4({INADDR_ANY}); }

bool IpAddress::is_link_local() const {
  return is_ipv4() ? bytes[12] == 169 && bytes[13] == 254 : bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80;
}

std::string IpAddress::to_string() const {
  char text[INET6_ADDRSTRLEN] = "";
  if (is_ipv4()) {
    ::inet_ntop(AF_INET, bytes.data() + ipv4_prefix.size(), text, sizeof(text));
  } else {
    ::inet_ntop(AF_INET6, bytes.data(), text, sizeof(text));
  }
  return text;
}

std::optional<IpAddress> parse_ip_address(std::string_view text) {
  const std::string terminated(text);
  if (terminated.find('\0') != std::string::npos) return std::nullopt;
  in_addr ipv4{};
  if (::inet_pton(AF_INET, terminated.c_str(), &ipv4) == 1) return from_ipv4(ipv4);
  in6_addr ipv6{};
  if (::inet_pton(AF_INET6, terminated.c_str(), &ipv6) == 1) return from_ipv6(ipv6);
  return std::nullopt;
}

IpAddress ip_address_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, &address, sizeof(ipv4));
    return from_ipv4(ipv4.sin_addr);
  }
  sockaddr_in6 ipv6{};
  std::memcpy(&ipv6, &address, sizeof(ipv6));
  return from_ipv6(ipv6.sin6_addr);
}

std::optional<IpAddress> reachable_address() {
  ifaddrs* interfaces = nullptr;
  if (::getifaddrs(&interfaces) != 0) return std::nullopt;
  std::optional<IpAddress> best;
  const auto rank = [](const IpAddress& address) {
    return (address.is_link_local() ? 2 : 0) + (address.is_ipv4() ? 0 : 1);
  };
  for (const ifaddrs* entry = interfaces; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || (entry->ifa_flags & IFF_UP) == 0) continue;
    const int family = entry->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    sockaddr_storage storage{};
    std::memcpy(&storage, entry->ifa_addr, family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
    const IpAddress address = ip_address_of(storage);
    if (address.is_loopback()) continue;
    if (!best || rank(address) < rank(*best)) best = address;
  }
  ::freeifaddrs(interfaces);
  return best;
}

}  // namespace alhazen::impl
