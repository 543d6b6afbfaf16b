#pragma once

// Which names a browser may have asked this server by. A site can let its own name resolve to the address of this
// server (DNS rebinding), and its pages would then be of the same origin as ours; but their requests carry that name.

#include <optional>
#include <string>
#include <string_view>

#include "view/server/ip_address.h"

namespace alhazen::impl {

class AllowedHosts {
 public:
  /// `name` is what the user has given, `listening` the address that it is.
  AllowedHosts(const std::string& name, const IpAddress& listening);

  /// Of a request's field Host: "localhost:8080", "[::1]:8080". Always allowed are loopback addresses and "localhost",
  /// under any port, since it differs where ssh forwards it; the address listened at, or any where that is a wildcard;
  /// and where others can reach it, the names of this machine.
  bool allows(std::string_view host) const;

 private:
  std::string name_;
  std::string machine_;  ///< as the system calls it; empty where only loopback is listened at
  IpAddress listening_;
};

}  // namespace alhazen::impl
