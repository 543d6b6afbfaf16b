#pragma once

namespace alhazen::impl {

/// Maximum nesting of arrays and objects in any JSON that is read: deeper values would exhaust the stack of code that
/// visits them recursively.
inline constexpr int max_json_depth = 128;

}  // namespace alhazen::impl
