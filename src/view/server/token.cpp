#include "view/server/token.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "util/diagnostics.h"

namespace alhazen::impl {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t got = ::getrandom(bytes.data() + count, bytes.size() - count, 0);
    if (got >= 0) {
      count += static_cast<size_t>(got);
    } else if (errno != EINTR) {
      throw RenderError(std::string("the system gives no random numbers for the page's token: ") +
                        std::strerror(errno));
    }
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

bool equal_tokens(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference =
        static_cast<unsigned char>(difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return difference == 0;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  });
}

}  // namespace alhazen::impl
