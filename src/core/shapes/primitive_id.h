#pragma once

// How primitives and instances are named.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// Instances stand in the leaves of the world's tree alone; what is met is a primitive of their object.
enum class PrimitiveKind : uint32_t { triangle = 0, sphere = 1, moving_sphere = 2, instance = 3 };

/// Kind in the two high bits, index into the array of that kind below.
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
