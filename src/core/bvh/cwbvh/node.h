#pragma once

// The compressed wide BVH for GPUs: 8 children a node, their boxes quantized to bytes (Ylitie, Karras, Laine 2017,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3).

#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// 80 bytes, five loads of 16. Child i's box goes from origin + low * 2^exponent to origin + high * 2^exponent, axis by
/// axis. Bytes of children lie four in a word, the first in the low bits.
struct alignas(16) CwbvhNode {
  static constexpr uint32_t children = 8;

  Vec3<float> origin;
  uint32_t exponents_and_inner;  ///< three exponents, biased by 127; high byte: bit i says that child i is a node
  uint32_t first_child;          ///< in cwbvh_nodes; children that are nodes are neighbours there
  uint32_t first_primitive;      ///< in cwbvh_primitives; those of all leaves among the children are neighbours
  /// A byte a child. Absent: 0. A node: 1 in the three high bits, 24 + i in the others. A leaf: its number of
  /// primitives in unary, and where they begin after first_primitive.
  uint32_t meta[2];
  uint32_t low[3][2], high[3][2];
};
static_assert(sizeof(CwbvhNode) == 80);

/// A copy of a primitive, so that its test reads no other array; primitive.h says what the kinds keep where.
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
