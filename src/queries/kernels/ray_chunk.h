#pragma once

// Reads rays from the arrays of a caller, and makes rays of the core of them: with unit directions, in render space and
// in the precision of the scene.

#include <bit>
#include <limits>

#include "core/math/ray.h"
#include "core/simd/soa.h"
#include "queries/kernels/chunk_tracer.h"
#include "queries/kernels/numbers.h"
#include "queries/kernels/ray_rows.h"
#include "queries/kernels/request.h"

namespace ALHAZEN_CORE {

/// Returns the greatest number below x, which is positive.
ALHAZEN_INLINE float number_below(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) - 1); }
ALHAZEN_INLINE double number_below(double x) { return std::bit_cast<double>(std::bit_cast<uint64_t>(x) - 1); }

/// The rays of a request. `Real` is the precision of the scene, `Number` that of the arrays.
template <class Real, class Number>
class RayChunk : public PreparedRays<Real> {
 public:
  using PreparedRays<Real>::capacity;

  /// Directions are normalized in the higher precision of both.
  using Wide = decltype(Real{} + Number{});

  explicit RayChunk(const SceneView<Real>& scene)
      : max_spread_(max_component(scene.bounds.high - scene.bounds.low) * Real(1.0 / 128)) {}

  /// Loads the rays [first, first + size), size <= capacity, of the request's.
  void load(const RayQueryRequest<Number>& request, size_t first, uint32_t size) {
    this->count = size;
    this->next_origins = {request.rays.origins, request.rays.origin_stride, first + size};
    this->next_directions = {request.rays.directions, request.rays.direction_stride, first + size};
    const double(&origin)[3] = request.world_origin;
    const bool is_moved = origin[0] != 0 || origin[1] != 0 || origin[2] != 0;
    for (uint32_t from = 0; from < size; from += tile) {
      const uint32_t some = min(tile, size - from);
      read(request.rays, first + from, some, t_max_ + from);
      const uint32_t rows = whole_rows(some);
      is_moved ? prepare<true>(origin, from, rows) : prepare<false>(origin, from, rows);
      set_rays(origin_, direction_, time_, rows, this->rays + from);
      for (uint32_t i = 0; i < rows; i += this->packet)
        this->is_coherent[(from + i) / this->packet] = is_packet_coherent(i);
    }
  }

  /// Returns the parameter of a hit at a distance, which rounding must not move out of the open interval of the ray; of
  /// a miss, infinity.
  ALHAZEN_INLINE Number parameter(uint32_t i, Real distance) const {
    const Number t = static_cast<Number>(static_cast<Wide>(distance) / length_[i]);
    const Number inside = max(t < t_max_[i] ? t : number_below(t_max_[i]), std::numeric_limits<Number>::denorm_min());
    return distance < infinity<Real> ? inside : infinity<Number>;
  }

 private:
  /// Rays that are prepared at a time: what is between the arrays of the caller and `rays` stays in the first-level
  /// cache.
  static constexpr uint32_t tile = 64;
  static_assert(capacity % tile == 0 && tile % PreparedRays<Real>::packet == 0);

  void read(const RayArrays<Number>& arrays, size_t first, uint32_t some, Number* t_max) {
    read_vectors(arrays.origins, arrays.origin_stride, first, some, given_origin_);
    read_vectors(arrays.directions, arrays.direction_stride, first, some, given_direction_);
    read_numbers(arrays.t_max, arrays.t_max_stride, infinity<Number>, first, some, t_max);
    read_numbers(arrays.times, arrays.time_stride, Number(0), first, some, given_time_);
    for (uint32_t i = some; i < whole_rows(some); ++i) {
      for (int axis = 0; axis < 3; ++axis) given_origin_[axis][i] = given_direction_[axis][i] = 0;
      given_time_[i] = t_max[i] = 0;
    }
  }

  /// `is_moved` tells whether `world_origin` is not 0.
  template <bool is_moved>
  ALHAZEN_NOINLINE void prepare(const double (&world_origin)[3], uint32_t first, uint32_t rows) {
    const double from_x = world_origin[0], from_y = world_origin[1], from_z = world_origin[2];
    const Number* const t_max = t_max_ + first;
    Wide* const length_of = length_ + first;
    Real* const limit_of = this->limit + first;
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
        if constexpr (!is_moved) return select(is_valid, static_cast<Real>(from), Real(0));
        return select(is_valid, static_cast<Real>(static_cast<double>(from) - by), Real(0));
      };
      length_of[i] = magnitude;
      limit_of[i] = valid(static_cast<Wide>(t_max[i]) * magnitude, 0);
      direction_[0][i] = valid(scaled.x / norm, 0);
      direction_[1][i] = valid(scaled.y / norm, 0);
      direction_[2][i] = valid(scaled.z / norm, 1);
      origin_[0][i] = moved(o.x, from_x);
      origin_[1][i] = moved(o.y, from_y);
      origin_[2][i] = moved(o.z, from_z);
      time_[i] = valid(static_cast<Wide>(min(max(given_time, Number(0)), Number(1))), 0);
    }
  }

  /// Returns whether the rays of a packet of the tile, of which the first is `first`, start within about `max_spread_`
  /// of each other in directions close to each other.
  ALHAZEN_INLINE bool is_packet_coherent(uint32_t first) const {
    using V = Lanes<Real, RayPacket<Real>::width>;
    constexpr Real max_direction_spread = Real(0.125);
    const auto is_within = [&](const Real* row, Real spread) {
      return less(V::all(spread), magnitude(V::load(row + first) - V::all(row[first]))) == 0;
    };
    return is_within(direction_[0], max_direction_spread) && is_within(direction_[1], max_direction_spread) &&
           is_within(direction_[2], max_direction_spread) && is_within(origin_[0], max_spread_) &&
           is_within(origin_[1], max_spread_) && is_within(origin_[2], max_spread_);
  }

  Real max_spread_;  ///< of the origins of coherent rays
  // Of the tile.
  Number given_origin_[3][tile], given_direction_[3][tile], given_time_[tile];
  Real origin_[3][tile], direction_[3][tile], time_[tile];
  // Of the chunk.
  Number t_max_[capacity];
  Wide length_[capacity];
};

}  // namespace ALHAZEN_CORE
