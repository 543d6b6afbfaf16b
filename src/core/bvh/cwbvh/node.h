#pragma once

// The compressed wide BVH for GPUs: 8 children per node, with boxes quantized to bytes (Ylitie, Karras, Laine 2017,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3).

#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// A node of 80 bytes, which five 16-byte loads read. On each axis, the box of child i spans origin + low * 2^exponent
/// to origin + high * 2^exponent. The bytes of four children share a word, the first in the low bits.
struct alignas(16) CwbvhNode {
  static constexpr uint32_t children = 8;

  Vec3<float> origin;
  uint32_t exponents_and_inner;  ///< three exponents, biased by 127; bit i of the high byte is set if child i is a node
  uint32_t first_child;          ///< in cwbvh_nodes, where the children that are nodes are contiguous
  uint32_t first_primitive;      ///< in cwbvh_primitives, where the primitives of all child leaves are contiguous
  /// One byte per child. Absent: 0. Node: 1 in the three high bits and 24 + slot in the low five. Leaf: the number of
  /// primitives in unary in the three high bits and their offset from first_primitive in the low five.
  uint32_t meta[2];
  uint32_t low[3][2], high[3][2];
};
static_assert(sizeof(CwbvhNode) == 80);

/// A copy of a primitive, so that its test reads no other array. primitive.h defines the fields of each kind.
struct alignas(16) CwbvhPrimitive {
  Vec3<float> a;
  PrimitiveId id;
  Vec3<float> b;
  uint32_t unused_b;
  Vec3<float> c;
  uint32_t unused_c;
};
static_assert(sizeof(CwbvhPrimitive) == 48);

inline constexpr uint32_t max_cwbvh_leaf = 3;

}  // namespace ALHAZEN_CORE
