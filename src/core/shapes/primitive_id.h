#pragma once

// Identifiers of primitives and instances.

#include <cstdint>

#include "core/math/platform.h"
#include "core/shapes/primitive_list.h"

namespace ALHAZEN_CORE {

/// Instances occur only in leaves of the world's tree; hits refer to primitives of their objects.
enum class PrimitiveKind : uint32_t {
#define ALHAZEN_KIND(X, kind, Record, records, Block, blocks) kind,
  ALHAZEN_PRIMITIVES(ALHAZEN_KIND, )
#undef ALHAZEN_KIND
      instance
};

/// Number of kinds, not counting `instance`.
inline constexpr uint32_t primitive_kinds = static_cast<uint32_t>(PrimitiveKind::instance);
static_assert(primitive_kinds <= 3, "PrimitiveId and Bvh8Child have two bits for a kind");

/// Packs the kind into the two high bits and the index into the array of that kind into the rest.
struct PrimitiveId {
  uint32_t bits = 0xffffffffu;

  PrimitiveId() = default;
  ALHAZEN_HD constexpr PrimitiveId(PrimitiveKind kind, uint32_t index)
      : bits((static_cast<uint32_t>(kind) << 30) | index) {}
  ALHAZEN_HD constexpr PrimitiveKind kind() const { return static_cast<PrimitiveKind>(bits >> 30); }
  ALHAZEN_HD constexpr uint32_t index() const { return bits & 0x3fffffffu; }
  ALHAZEN_HD constexpr bool is_none() const { return bits == 0xffffffffu; }
  friend ALHAZEN_HD constexpr bool operator==(PrimitiveId, PrimitiveId) = default;
};
inline constexpr uint32_t max_primitives_of_a_kind = 0x3fffffffu;

inline constexpr uint32_t no_instance = 0xffffffffu;

}  // namespace ALHAZEN_CORE
