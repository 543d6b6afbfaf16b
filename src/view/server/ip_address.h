#pragma once

// Addresses of this machine and of others, as the numbers of IPv4 and IPv6 (RFC 4291).

#include <sys/socket.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace alhazen::impl {

/// One of IPv4 is here as the IPv6 address that it is mapped to, so that both are compared alike.
struct IpAddress {
  std::array<unsigned char, 16> bytes{};

  bool operator==(const IpAddress&) const = default;
  bool is_ipv4() const;
  bool is_loopback() const;    ///< 127.0.0.0/8 or ::1
  bool is_wildcard() const;    ///< 0.0.0.0 or ::, which stand for all addresses of the machine
  bool is_link_local() const;  ///< 169.254.0.0/16 or fe80::/10
  std::string to_string() const;
};

/// Nothing for names, and for all but the usual forms: "127.0.0.1", "::1".
std::optional<IpAddress> parse_ip_address(std::string_view text);

IpAddress ip_address_of(const sockaddr_storage& address);

/// An address at which other machines may reach this one: of an interface that is up, rather IPv4 and rather not
/// link-local. Nothing if it has none but loopback, or on an error.
std::optional<IpAddress> reachable_address();

}  // namespace alhazen::impl
