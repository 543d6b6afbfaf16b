#pragma once

// Reduces the work of tests under sanitizers, which make them slow.

#include <cstddef>

namespace alhazen::impl::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool is_sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool is_sanitized = false;
#endif

/// Returns `full`, or a sixteenth of it under sanitizers.
constexpr size_t effort(size_t full) { return is_sanitized ? full / 16 : full; }

/// Returns a bound on the error of a mean over `effort(n)` samples; a sixteenth of them has four times the error.
constexpr double widened(double bound) { return is_sanitized ? 4 * bound : bound; }

}  // namespace alhazen::impl::test
