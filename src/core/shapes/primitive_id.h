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
static_assert(primitive_kinds <= 7, "PrimitiveId and Bvh8Child have three bits for a kind");

/// Packs the kind into the three high bits and the index into the array of that kind into the rest.
struct PrimitiveId {
  static constexpr uint32_t index_bits = 29;

  uint32_t bits = 0xffffffffu;

  PrimitiveId() = default;
  ALHAZEN_HD constexpr PrimitiveId(PrimitiveKind kind, uint32_t index)
      : bits((static_cast<uint32_t>(kind) << index_bits) | index) {}
  ALHAZEN_HD constexpr PrimitiveKind kind() const { return static_cast<PrimitiveKind>(bits >> index_bits); }
  ALHAZEN_HD constexpr uint32_t index() const { return bits & ((1u << index_bits) - 1); }
  ALHAZEN_HD constexpr bool is_none() const { return bits == 0xffffffffu; }
  friend ALHAZEN_HD constexpr bool operator==(PrimitiveId, PrimitiveId) = default;
};
inline constexpr uint32_t max_primitives_of_a_kind = (1u << PrimitiveId::index_bits) - 1;

inline constexpr uint32_t no_instance = 0xffffffffu;

}  // namespace ALHAZEN_CORE
