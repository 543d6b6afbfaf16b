#pragma once

// The BVH for CPUs: nodes with 8 children, and leaves of blocks of primitives of one kind, both stored as structures of
// arrays for SIMD instructions. Boxes are float in both precisions, so that double only makes primitives larger.

#include <cstdint>

#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

inline constexpr int bvh8_width = 8;

/// Packs a child of a node into 32 bits: another node, an instance, or a leaf with blocks of primitives of one kind.
struct Bvh8Child {
  enum Kind : uint32_t {
    node,
#define ALHAZEN_KIND(X, kind, Record, records, Block, blocks) records,
    ALHAZEN_PRIMITIVES(ALHAZEN_KIND, )
#undef ALHAZEN_KIND
        kinds
  };
  static constexpr uint32_t index_bits = 26, kind_shift = 29, max_blocks = 7;

  static constexpr uint32_t pack(Kind kind, uint32_t blocks, uint32_t first) {
    return static_cast<uint32_t>(kind) << kind_shift | blocks << index_bits | first;
  }
  /// Returns the kind of leaves with such primitives.
  static constexpr Kind kind(PrimitiveKind primitive) {
    return static_cast<Kind>(static_cast<uint32_t>(primitive) + 1);
  }
  static constexpr Kind kind(uint32_t child) { return static_cast<Kind>(child >> kind_shift); }
  static constexpr uint32_t blocks(uint32_t child) { return child >> index_bits & max_blocks; }
  static constexpr uint32_t first(uint32_t child) { return child & ((1u << index_bits) - 1); }
  /// Returns the child for an instance, which is encoded as a leaf of spheres with 0 blocks and the instance's index.
  static constexpr uint32_t instance(uint32_t index) { return pack(spheres, 0, index); }
  static constexpr bool is_instance(uint32_t child) { return child >> index_bits == instance(0) >> index_bits; }
  static constexpr uint32_t max_index_count = 1u << index_bits;
  /// An empty leaf, which fills the unused slots of a node.
  static constexpr uint32_t nothing = 1u << kind_shift;
};

struct alignas(32) Bvh8Node {
  float bounds[6][bvh8_width];  ///< [2 * axis] is the low side, [2 * axis + 1] the high side
  uint32_t child[bvh8_width];
};

/// Unused lanes have three equal vertices, which are never hit.
template <class Real>
struct TriangleBlock {
  static constexpr int lanes = 4;
  Real vertex[3][3][lanes];  ///< [vertex][axis]
  uint32_t index[lanes];     ///< in SceneView::triangles
};

template <class Record>
struct RecordBlock;

/// Records of one kind other than triangles. Unused lanes hold NaN.
template <template <class> class Record, class Real>
struct RecordBlock<Record<Real>> {
  static constexpr int lanes = 8;
  Real number[Record<Real>::numbers][lanes];  ///< those that the intersection test reads
  uint32_t index[lanes];                      ///< in the array of these records
};

}  // namespace ALHAZEN_CORE
