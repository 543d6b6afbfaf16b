#pragma once

// Reads rays from the arrays of a caller, and makes rays of the core of them: with unit directions, in render space and
// in the precision of the scene.

#include <bit>
#include <limits>

#include "core/math/ray.h"
#include "core/simd/soa.h"
#include "queries/kernels/chunk_tracer.h"
#include "queries/kernels/request.h"

namespace ALHAZEN_CORE {

/// Arrays of callers need not be aligned.
template <class Number>
ALHAZEN_INLINE Number load_number(const Number* from) {
  Number number;
  __builtin_memcpy(&number, from, sizeof(number));
  return number;
}

/// Returns the greatest number below x, which is positive.
ALHAZEN_INLINE float number_below(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) - 1); }
ALHAZEN_INLINE double number_below(double x) { return std::bit_cast<double>(std::bit_cast<uint64_t>(x) - 1); }

template <class Number>
ALHAZEN_INLINE void store_number(Number* to, Number number) {
  __builtin_memcpy(to, &number, sizeof(number));
}

/// The rays of a request. `Real` is the precision of the scene, `Number` that of the arrays.
template <class Real, class Number>
class RayChunk : public PreparedRays<Real> {
 public:
  using PreparedRays<Real>::capacity;

  /// Directions are normalized in the higher precision of both.
  using Wide = decltype(Real{} + Number{});

  /// Loads the rays [first, first + size), size <= capacity, of the request's.
  void load(const RayQueryRequest<Number>& request, size_t first, uint32_t size) {
    this->count = size;
    read(request.rays, first);
    prepare(request.world_origin);
    for (uint32_t i = 0; i < size; ++i)
      this->rays[i] = {{this->origin[0][i], this->origin[1][i], this->origin[2][i]},
                       {this->direction[0][i], this->direction[1][i], this->direction[2][i]},
                       this->time[i]};
  }

  /// Returns the parameter of a hit at a distance, which rounding must not move out of the open interval of the ray.
  ALHAZEN_INLINE Number parameter(uint32_t i, Real distance) const {
    const Number t = static_cast<Number>(static_cast<Wide>(distance) / length_[i]);
    return max(t < t_max_[i] ? t : number_below(t_max_[i]), std::numeric_limits<Number>::denorm_min());
  }

 private:
  void read(const RayArrays<Number>& arrays, size_t first) {
    const auto at = [&](const Number* array, std::ptrdiff_t stride, uint32_t i) {
      return array + static_cast<std::ptrdiff_t>(first + i) * stride;
    };
    for (uint32_t i = 0; i < this->count; ++i) {
      const Number* const o = at(arrays.origins, arrays.origin_stride, i);
      const Number* const d = at(arrays.directions, arrays.direction_stride, i);
      for (int axis = 0; axis < 3; ++axis) {
        given_origin_[axis][i] = load_number(o + axis);
        given_direction_[axis][i] = load_number(d + axis);
      }
    }
    for (uint32_t i = 0; i < this->count; ++i)
      t_max_[i] = arrays.t_max ? load_number(at(arrays.t_max, arrays.t_max_stride, i)) : infinity<Number>;
    for (uint32_t i = 0; i < this->count; ++i)
      given_time_[i] = arrays.times ? load_number(at(arrays.times, arrays.time_stride, i)) : Number(0);
    for (uint32_t i = this->count; i < whole_rows(this->count); ++i) {
      for (int axis = 0; axis < 3; ++axis) given_origin_[axis][i] = given_direction_[axis][i] = 0;
      given_time_[i] = t_max_[i] = 0;
    }
  }

  void prepare(const double (&world_origin)[3]) {
    const uint32_t rows = whole_rows(this->count);
    const double from_x = world_origin[0], from_y = world_origin[1], from_z = world_origin[2];
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < rows; ++i) {
      const Vec3<Number> o{given_origin_[0][i], given_origin_[1][i], given_origin_[2][i]};
      const Vec3<Number> d{given_direction_[0][i], given_direction_[1][i], given_direction_[2][i]};
      const Number given_time = given_time_[i];
      const Vec3<Wide> wide{static_cast<Wide>(d.x), static_cast<Wide>(d.y), static_cast<Wide>(d.z)};
      // Scaled first, so that squares neither overflow nor underflow.
      const Wide largest = max_component(abs(wide));
      const Vec3<Wide> scaled = wide / largest;
      const Wide norm = length(scaled), magnitude = largest * norm;
      // NaN unless all are finite.
      const Number zero = o.x * 0 + o.y * 0 + o.z * 0 + d.x * 0 + d.y * 0 + d.z * 0 + given_time * 0;
      const bool is_valid = (zero == 0) & (largest > 0);
      const auto valid = [&](Wide number, Real otherwise)
                             ALHAZEN_INLINE_LAMBDA { return select(is_valid, static_cast<Real>(number), otherwise); };
      const auto moved = [&](Number from, double by) ALHAZEN_INLINE_LAMBDA {
        return select(is_valid, static_cast<Real>(static_cast<double>(from) - by), Real(0));
      };
      length_[i] = magnitude;
      this->limit[i] = valid(static_cast<Wide>(t_max_[i]) * magnitude, 0);
      this->direction[0][i] = valid(scaled.x / norm, 0);
      this->direction[1][i] = valid(scaled.y / norm, 0);
      this->direction[2][i] = valid(scaled.z / norm, 1);
      this->origin[0][i] = moved(o.x, from_x);
      this->origin[1][i] = moved(o.y, from_y);
      this->origin[2][i] = moved(o.z, from_z);
      this->time[i] = valid(static_cast<Wide>(min(max(given_time, Number(0)), Number(1))), 0);
    }
  }

  Number given_origin_[3][capacity], given_direction_[3][capacity], given_time_[capacity], t_max_[capacity];
  Wide length_[capacity];
};

}  // namespace ALHAZEN_CORE
