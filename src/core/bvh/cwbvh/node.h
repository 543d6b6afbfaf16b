#pragma once

// The compressed wide BVH for GPUs: eight children a node, their boxes in bytes (Ylitie, Karras, Laine 2017, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3).

#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// 80 bytes, five loads of 16. Child i's box goes from origin + low * 2^exponent to origin + high * 2^exponent, axis by
/// axis. Bytes of children lie four in a word, the first in the low bits.
struct alignas(16) CwbvhNode {
  static constexpr uint32_t children = 8;

  Vec3<float> origin;
  uint32_t exponents_and_inner;  ///< three exponents, biased by 127; high byte: bit i says that child i is a node
  uint32_t first_child;          ///< in cwbvh_nodes; children that are nodes follow each other
  uint32_t first_primitive;      ///< in cwbvh_primitives; those of all leaves among the children follow each other
  /// A byte a child. Absent: 0. A node: 1 in the three high bits, 24 + i in the others. A leaf: its number of
  /// primitives in unary, and where they begin after first_primitive.
  uint32_t meta[2];
  uint32_t low[3][2], high[3][2];
};
static_assert(sizeof(CwbvhNode) == 80);

/// A primitive with its coordinates, so that a ray needs to look nowhere else. Triangle: a, b, c are its vertices.
/// Sphere: centre a, radius b.x. Moving sphere: centre a, radius b.x, motion c. Of an instance the id alone counts.
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
