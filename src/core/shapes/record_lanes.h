#pragma once

// For intersection tests on SIMD lanes, each of which pairs a ray with a primitive: one ray with many primitives
// (core/bvh/bvh8/blocks.h), or many rays with one primitive (packets.h).

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

// The operations of Lanes (core/simd/lanes.h) on a single number, for tests that are written once for both. Bit 0 is
// that of the number.

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE uint32_t less(Real a, Real b) {
  return a < b ? 1 : 0;
}

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE uint32_t less_equal(Real a, Real b) {
  return a <= b ? 1 : 0;
}

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE Real where_less(Real a, Real b, Real x, Real y) {
  return a < b ? x : y;
}

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE Real choose(uint32_t lanes, Real a, Real b) {
  return lanes & 1 ? a : b;
}

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE Real magnitude(Real x) {
  return std::abs(x);
}

template <std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE Real square_root(Real x) {
  return std::sqrt(x);
}

/// Returns x, for every lane of V.
template <class V, std::floating_point Real>
ALHAZEN_HD ALHAZEN_INLINE V on_all_lanes(Real x) {
  if constexpr (std::is_same_v<V, Real>)
    return x;
  else
    return V::all(x);
}

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
