#pragma once

// What the loops over queries are handed. Nothing here depends on the instruction set that they are compiled for.

#include <cstdint>

namespace alhazen::test {

/// One ray a call, all in turns, all in one call as renders do it, or all in one as rays of which neighbours go much
/// the same way.
enum class Way : uint32_t { one, in_turns, many, coherent };
inline constexpr Way ways[] = {Way::one, Way::in_turns, Way::many, Way::coherent};

/// Arrays of `count` elements of the precision asked for: rays and limits, and what comes of them.
struct QueryRequest {
  const void* scene;
  const void* rays;
  const void* limits;
  uint32_t count;
  void* hits;
  bool* found;
};

using AnswerQueries = void (*)(const QueryRequest&);

}  // namespace alhazen::test
