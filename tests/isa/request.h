#pragma once

// The arguments of the query loops. Nothing here depends on the instruction set for which they are compiled.

#include <cstdint>

namespace alhazen::impl::test {

/// How the queries are made: one ray per call, interleaved, all in one call as in renders, or all in one call as
/// coherent packets.
enum class QueryMode : uint32_t { single, interleaved, many, coherent };
inline constexpr QueryMode query_modes[] = {QueryMode::single, QueryMode::interleaved, QueryMode::many,
                                            QueryMode::coherent};

/// Arrays of `count` elements in the requested precision: rays and limits, and the results.
struct QueryRequest {
  const void* scene;
  const void* rays;
  const void* limits;
  uint32_t count;
  void* hits;
  bool* found;
};

using AnswerQueries = void (*)(const QueryRequest&);

}  // namespace alhazen::impl::test
