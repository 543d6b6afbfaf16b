#pragma once

// The arguments of a sample kernel. Nothing here depends on the instruction set for which the kernel is compiled.

#include <cstdint>

namespace alhazen::impl {

/// Samples [first, first + count), count <= samples_per_block, of pixel (x, y) of the whole image.
struct BlockRequest {
  uint32_t x, y, first, count;
};

/// Maximum number of blocks per request.
inline constexpr uint32_t max_blocks_per_request = 256;

/// Base of what the intersectors of other libraries trace rays by. An intersector names its own type as `Tracer`.
struct ExternalTracer {};

struct KernelRequest {
  const void* scene;             ///< SceneView<Real>
  const ExternalTracer* tracer;  ///< Intersector::Tracer, if it has one
  void* sums;                    ///< BlockSum<Real>, one per block
  void* parts;                   ///< PartedLight<Real>, samples_per_block for each block, or null
  const BlockRequest* blocks;
  uint32_t block_count;
  uint32_t seed, screen_order;  ///< of a SampleSeed
  uint32_t max_segments;
  bool wants_first_hit, wants_first_point;
};

using RawKernel = void (*)(const KernelRequest&);

}  // namespace alhazen::impl
