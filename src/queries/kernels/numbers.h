#pragma once

// Reads and writes the arrays of callers, which need not be aligned.

#include <cstddef>
#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

template <class Number>
ALHAZEN_INLINE Number load_number(const Number* from) {
  Number number;
  __builtin_memcpy(&number, from, sizeof(number));
  return number;
}

template <class Number>
ALHAZEN_INLINE void store_number(Number* to, Number number) {
  __builtin_memcpy(to, &number, sizeof(number));
}

/// Reads the vectors [first, first + count) of an array to one row per axis. SIMD instructions take adjacent ones
/// apart.
template <class Number, size_t size>
ALHAZEN_NOINLINE void read_vectors(const Number* array, std::ptrdiff_t stride, size_t first, uint32_t count,
                                   Number (&to)[3][size]) {
  const Number* from = array + static_cast<std::ptrdiff_t>(first) * stride;
  if (stride == 3) {
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < count; ++i)
      for (uint32_t axis = 0; axis < 3; ++axis) to[axis][i] = load_number(from + 3 * i + axis);
    return;
  }
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t axis = 0; axis < 3; ++axis)
      to[axis][i] = load_number(from + static_cast<std::ptrdiff_t>(i) * stride + axis);
}

/// Reads the numbers [first, first + count) of an array; `absent` if there is none.
template <class Number>
ALHAZEN_NOINLINE void read_numbers(const Number* array, std::ptrdiff_t stride, Number absent, size_t first,
                                   uint32_t count, Number* to) {
  if (!array) {
    for (uint32_t i = 0; i < count; ++i) to[i] = absent;
    return;
  }
  const Number* from = array + static_cast<std::ptrdiff_t>(first) * stride;
  if (stride == 1)
    __builtin_memcpy(to, from, count * sizeof(Number));
  else
    for (uint32_t i = 0; i < count; ++i) to[i] = load_number(from + static_cast<std::ptrdiff_t>(i) * stride);
}

/// Writes `count` vectors of `size` components, of which component(i, k) is the k-th of vector i.
template <size_t size, class Number, class Component>
ALHAZEN_INLINE void write_vectors(Number* to, uint32_t count, const Component& component) {
  ALHAZEN_SIDE_BY_SIDE
  for (uint32_t i = 0; i < count; ++i)
    for (size_t k = 0; k < size; ++k) store_number(to + i * size + k, static_cast<Number>(component(i, k)));
}

}  // namespace ALHAZEN_CORE
