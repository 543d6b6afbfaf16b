#pragma once

// Opens the socket that the server accepts connections at.

#include <string>

#include "view/server/ip_address.h"

namespace alhazen::impl {

/// Owns a socket that listens, without blocking and not for programs that this one starts.
class ListeningSocket {
 public:
  /// The options of page_server.h, and its errors.
  ListeningSocket(const std::string& address, int port, bool only_this_port);
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  int port() const { return port_; }
  const IpAddress& address() const { return address_; }
  /// Gives up the socket to the caller.
  int release();
  /// For URLs on this machine or, where all addresses are listened at, on others.
  std::string url_host() const;

 private:
  int descriptor_ = -1;
  int port_ = 0;
  IpAddress address_;
};

}  // namespace alhazen::impl
