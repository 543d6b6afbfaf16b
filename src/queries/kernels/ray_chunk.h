#pragma once

// Reads rays from the arrays of a caller, and makes rays of the core of them: with unit directions, in render space and
// in the precision of the scene.

#include <bit>
#include <limits>

#include "core/bvh/bvh8/packets.h"
#include "core/math/ray.h"
#include "core/simd/soa.h"
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
class RayChunk {
 public:
  /// Directions are normalized in the higher precision of both.
  using Wide = decltype(Real{} + Number{});

  /// The rays and their hits stay in the second-level cache.
  static constexpr uint32_t capacity = 1024;

  /// Loads the rays [first, first + count), count <= capacity, of the request's.
  void load(const RayQueryRequest<Number>& request, size_t first, uint32_t count) {
    count_ = count;
    read(request.rays, first);
    prepare(request.world_origin);
    for (uint32_t i = 0; i < count_; ++i)
      rays_[i] = {{origin_[0][i], origin_[1][i], origin_[2][i]},
                  {direction_[0][i], direction_[1][i], direction_[2][i]},
                  time_[i]};
  }

  const Ray<Real>& ray(uint32_t i) const { return rays_[i]; }
  /// In units of world space; 0 for rays that hit nothing.
  Real limit(uint32_t i) const { return limit_[i]; }

  /// Returns the parameter of a hit at a distance, which rounding must not move out of the open interval of the ray.
  ALHAZEN_INLINE Number parameter(uint32_t i, Real distance) const {
    const Number t = static_cast<Number>(static_cast<Wide>(distance) / length_[i]);
    return max(t < t_max_[i] ? t : number_below(t_max_[i]), std::numeric_limits<Number>::denorm_min());
  }

  /// Returns whether the rays [first, first + count) start close to each other, in directions close to each other, so
  /// that most of them visit the same nodes.
  bool is_coherent(uint32_t first, uint32_t count, Real max_spread) const {
    Real low[6], high[6];
    for (int k = 0; k < 6; ++k) {
      const Real* const row = k < 3 ? origin_[k] + first : direction_[k - 3] + first;
      Real least = row[0], most = row[0];
      for (uint32_t i = 1; i < count; ++i) {
        least = min(least, row[i]);
        most = max(most, row[i]);
      }
      low[k] = least;
      high[k] = most;
    }
    bool is_coherent = true;
    for (int axis = 0; axis < 3; ++axis)
      is_coherent &= high[axis] - low[axis] <= max_spread && high[3 + axis] - low[3 + axis] <= max_direction_spread;
    return is_coherent;
  }

 private:
  static constexpr Real max_direction_spread = Real(0.125);

  void read(const RayArrays<Number>& rays, size_t first) {
    const auto at = [&](const Number* array, std::ptrdiff_t stride, uint32_t i) {
      return array + static_cast<std::ptrdiff_t>(first + i) * stride;
    };
    for (uint32_t i = 0; i < count_; ++i) {
      const Number* const origin = at(rays.origins, rays.origin_stride, i);
      const Number* const direction = at(rays.directions, rays.direction_stride, i);
      for (int axis = 0; axis < 3; ++axis) {
        given_origin_[axis][i] = load_number(origin + axis);
        given_direction_[axis][i] = load_number(direction + axis);
      }
    }
    for (uint32_t i = 0; i < count_; ++i)
      t_max_[i] = rays.t_max ? load_number(at(rays.t_max, rays.t_max_stride, i)) : infinity<Number>;
    for (uint32_t i = 0; i < count_; ++i)
      given_time_[i] = rays.times ? load_number(at(rays.times, rays.time_stride, i)) : Number(0);
    for (uint32_t i = count_; i < whole_rows(count_); ++i) {
      for (int axis = 0; axis < 3; ++axis) given_origin_[axis][i] = given_direction_[axis][i] = 0;
      given_time_[i] = t_max_[i] = 0;
    }
  }

  void prepare(const double (&world_origin)[3]) {
    const uint32_t rows = whole_rows(count_);
    const double from_x = world_origin[0], from_y = world_origin[1], from_z = world_origin[2];
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < rows; ++i) {
      const Vec3<Number> o{given_origin_[0][i], given_origin_[1][i], given_origin_[2][i]};
      const Vec3<Number> d{given_direction_[0][i], given_direction_[1][i], given_direction_[2][i]};
      const Number time = given_time_[i];
      const Vec3<Wide> wide{static_cast<Wide>(d.x), static_cast<Wide>(d.y), static_cast<Wide>(d.z)};
      // Scaled first, so that squares neither overflow nor underflow.
      const Wide largest = max_component(abs(wide));
      const Vec3<Wide> scaled = wide / largest;
      const Wide norm = length(scaled), magnitude = largest * norm;
      // NaN unless all are finite.
      const Number zero = o.x * 0 + o.y * 0 + o.z * 0 + d.x * 0 + d.y * 0 + d.z * 0 + time * 0;
      const bool is_valid = (zero == 0) & (largest > 0);
      const auto valid = [&](Wide number, Real otherwise)
                             ALHAZEN_INLINE_LAMBDA { return select(is_valid, static_cast<Real>(number), otherwise); };
      const auto moved = [&](Number from, double by) ALHAZEN_INLINE_LAMBDA {
        return select(is_valid, static_cast<Real>(static_cast<double>(from) - by), Real(0));
      };
      length_[i] = magnitude;
      limit_[i] = valid(static_cast<Wide>(t_max_[i]) * magnitude, 0);
      direction_[0][i] = valid(scaled.x / norm, 0);
      direction_[1][i] = valid(scaled.y / norm, 0);
      direction_[2][i] = valid(scaled.z / norm, 1);
      origin_[0][i] = moved(o.x, from_x);
      origin_[1][i] = moved(o.y, from_y);
      origin_[2][i] = moved(o.z, from_z);
      time_[i] = valid(static_cast<Wide>(min(max(time, Number(0)), Number(1))), 0);
    }
  }

  uint32_t count_ = 0;
  Number given_origin_[3][capacity], given_direction_[3][capacity], given_time_[capacity], t_max_[capacity];
  Wide length_[capacity];
  Real origin_[3][capacity], direction_[3][capacity], time_[capacity], limit_[capacity];
  Ray<Real> rays_[capacity];
};

}  // namespace ALHAZEN_CORE
