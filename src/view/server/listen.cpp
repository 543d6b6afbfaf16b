#include "view/server/listen.h"

#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "util/diagnostics.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

constexpr int max_port = 65535;

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

[[noreturn]] void refuse_address(const std::string& address, const std::string& why) {
  throw InputError("address '" + printable(address) + "': " + why +
                   ": give an address of this machine, such as 127.0.0.1, ::1, or 0.0.0.0 for all of its IPv4 ones");
}

SocketAddress resolve(const std::string& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  // Resolvers take an empty name, and one that ends at a zero byte, for another.
  if (address.empty() || address.find('\0') != std::string::npos) refuse_address(address, "it is no address");
  const int status = ::getaddrinfo(address.c_str(), nullptr, &hints, &found);
  if (status != 0) refuse_address(address, status == EAI_SYSTEM ? std::strerror(errno) : ::gai_strerror(status));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  SocketAddress result;
  // A name may have addresses of both kinds; links and scripts mostly say 127.0.0.1.
  const addrinfo* chosen = found;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next)
    if (entry->ai_family == AF_INET && chosen->ai_family != AF_INET) chosen = entry;
  std::memcpy(&result.storage, chosen->ai_addr, chosen->ai_addrlen);
  result.size = chosen->ai_addrlen;
  return result;
}

void set_port(SocketAddress& address, int port) {
  const in_port_t number = htons(static_cast<uint16_t>(port));
  if (address.storage.ss_family == AF_INET) {
    reinterpret_cast<sockaddr_in*>(&address.storage)->sin_port = number;
  } else {
    reinterpret_cast<sockaddr_in6*>(&address.storage)->sin6_port = number;
  }
}

int port_of(int descriptor) {
  SocketAddress address;
  address.size = sizeof(address.storage);
  if (::getsockname(descriptor, address.get(), &address.size) != 0) return 0;
  return ntohs(address.storage.ss_family == AF_INET ? reinterpret_cast<sockaddr_in*>(&address.storage)->sin_port
                                                    : reinterpret_cast<sockaddr_in6*>(&address.storage)->sin6_port);
}

void set_flag(int descriptor, int level, int name, int value) {
  // These make it more convenient; a system that refuses them can serve pages all the same.
  static_cast<void>(::setsockopt(descriptor, level, name, &value, sizeof(value)));
}

/// Returns a socket, or the negative number of the error.
int try_to_listen(const SocketAddress& address) {
  const int descriptor = ::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return -errno;
  // A server that has just ended does not keep its port from the next one.
  set_flag(descriptor, SOL_SOCKET, SO_REUSEADDR, 1);
  // "::" is meant for IPv4 as well.
  if (address.storage.ss_family == AF_INET6) set_flag(descriptor, IPPROTO_IPV6, IPV6_V6ONLY, 0);
  if (::bind(descriptor, address.get(), address.size) == 0 && ::listen(descriptor, 64) == 0) return descriptor;
  const int error = errno;
  ::close(descriptor);
  return -error;
}

[[noreturn]] void refuse(const std::string& address, int port, int error) {
  const std::string name = "port " + std::to_string(port) + ": ";
  switch (error) {
    case EADDRINUSE:
      throw InputError(name + (port == max_port ? "it is in use, and there is no higher one: choose a lower port"
                                                : "another program is using it: choose another port, or end that one"));
    case EACCES:
      throw InputError(name + "permission denied: ports below 1024 are the administrator's, choose one above");
    case EADDRNOTAVAIL:
      refuse_address(address, "this machine does not have it");
    case EAFNOSUPPORT:
      refuse_address(address, "this machine has no such network");
    default:
      throw InputError("cannot listen at '" + printable(address) + "', port " + std::to_string(port) + ": " +
                       std::strerror(error));
  }
}

}  // namespace

ListeningSocket::ListeningSocket(const std::string& address, int port, bool only_this_port) {
  if (port < 0 || port > max_port)
    throw InputError("port " + std::to_string(port) + ": ports are numbers from 1 to 65535, or 0 for any free one");
  SocketAddress where = resolve(address);
  address_ = ip_address_of(where.storage);
  for (;; ++port) {
    set_port(where, port);
    descriptor_ = try_to_listen(where);
    if (descriptor_ >= 0) break;
    const bool is_taken = descriptor_ == -EADDRINUSE;
    if (!is_taken || only_this_port || port == 0 || port == max_port) refuse(address, port, -descriptor_);
  }
  port_ = port == 0 ? port_of(descriptor_) : port;
}

ListeningSocket::~ListeningSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int ListeningSocket::release() { return std::exchange(descriptor_, -1); }

std::string ListeningSocket::url_host() const {
  IpAddress shown = address_;
  if (shown.is_wildcard()) {
    const auto reachable = reachable_address();
    const char* loopback = shown.is_ipv4() ? "127.0.0.1" : "::1";
    shown = reachable && (reachable->is_ipv4() || !shown.is_ipv4()) ? *reachable : *parse_ip_address(loopback);
  }
  return shown.is_ipv4() ? shown.to_string() : '[' + shown.to_string() + ']';
}

}  // namespace alhazen::impl
