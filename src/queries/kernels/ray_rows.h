#pragma once

// Brings the numbers of rays, in one row each, into rays.

#include <cstddef>
#include <type_traits>

#include "core/math/ray.h"

namespace ALHAZEN_CORE {

/// Four columns of rows become four rows.
template <class Real>
class FourByFour {
 public:
  typedef Real Row __attribute__((vector_size(4 * sizeof(Real))));

  ALHAZEN_INLINE FourByFour(const Real* a, const Real* b, const Real* c, const Real* d) {
    const Real* const from[4] = {a, b, c, d};
    Row row[4];
    for (int i = 0; i < 4; ++i) __builtin_memcpy(&row[i], from[i], sizeof(Row));
    const Row ab_low = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
    const Row ab_high = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
    const Row cd_low = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
    const Row cd_high = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
    column_[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    column_[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    column_[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    column_[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
  }

  ALHAZEN_INLINE void store_column(uint32_t i, void* to) const { __builtin_memcpy(to, &column_[i], sizeof(Row)); }

 private:
  Row column_[4];
};

/// Sets the origins, directions and times of `count` rays, a multiple of 4, and that they leave no surface.
template <class Real, size_t size>
ALHAZEN_INLINE void set_rays(const Real (&origin)[3][size], const Real (&direction)[3][size], const Real (&time)[size],
                             uint32_t count, Ray<Real>* rays) {
  static_assert(std::is_trivially_copyable_v<Ray<Real>> && sizeof(Ray<Real>) >= 8 * sizeof(Real));
  static_assert(offsetof(Ray<Real>, direction) == 3 * sizeof(Real) && offsetof(Ray<Real>, time) == 6 * sizeof(Real) &&
                offsetof(Ray<Real>, left) == 7 * sizeof(Real));
  // What follows the time: a float of `left`, or a double of this and left_instance, which stays as it is otherwise.
  const Ray<Real> leaves_nothing{};
  Real rest[4];
  for (Real& number : rest)
    __builtin_memcpy(&number, reinterpret_cast<const char*>(&leaves_nothing) + 7 * sizeof(Real), sizeof(Real));
  for (uint32_t i = 0; i < count; i += 4) {
    const FourByFour<Real> first(origin[0] + i, origin[1] + i, origin[2] + i, direction[0] + i);
    const FourByFour<Real> second(direction[1] + i, direction[2] + i, time + i, rest);
    for (uint32_t k = 0; k < 4; ++k) {
      first.store_column(k, reinterpret_cast<char*>(rays + i + k));
      second.store_column(k, reinterpret_cast<char*>(rays + i + k) + 4 * sizeof(Real));
    }
  }
}

}  // namespace ALHAZEN_CORE
