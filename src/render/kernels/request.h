#pragma once

// What a sample kernel is handed. Nothing here depends on the instruction set that the kernel was compiled for.

#include <cstdint>

namespace alhazen {

/// Samples [first, first + count), count <= samples_per_block, of pixel (x, y) of the whole picture.
struct BlockRequest {
  uint32_t x, y, first, count;
};

/// Blocks are taken this many at a time at most.
inline constexpr uint32_t most_blocks_per_request = 256;

struct KernelRequest {
  const void* scene;   ///< SceneView<Real>
  const void* tracer;  ///< what the intersector wants besides it
  void* sums;          ///< BlockSum<Real>, one a block
  const BlockRequest* blocks;
  uint32_t block_count;
  uint32_t seed;
  uint32_t max_segments;
  bool wants_first_hit;
};

using RawKernel = void (*)(const KernelRequest&);

}  // namespace alhazen
