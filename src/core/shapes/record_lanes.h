#pragma once

// For intersection tests on SIMD lanes, each of which pairs a ray with a primitive: one ray with many primitives
// (core/bvh/bvh8/blocks.h), or many rays with one primitive (packets.h).

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// The numbers of records that their intersection test reads (Record::number): `read(k)` returns number k of the record
/// on each lane.
template <class Record, class Read>
struct NumbersOf {
  const Read& read;

  ALHAZEN_HD ALHAZEN_INLINE auto operator[](int k) const { return read(k); }
};

template <class Record, class Read>
ALHAZEN_HD ALHAZEN_INLINE NumbersOf<Record, Read> numbers_of(const Read& read) {
  return {read};
}

/// A ray on each lane.
template <class V>
struct RayLanes {
  V origin[3], direction[3], time;
};

}  // namespace ALHAZEN_CORE
