#pragma once

// Random numbers of many paths, generated together in loops that compilers turn into SIMD instructions, which suit
// integer hashes well.

#include "core/math/vec.h"
#include "core/sampling/sampler.h"
#include "core/simd/soa.h"

namespace ALHAZEN_CORE {

/// `Dimensions::count` dimensions for each of up to `max_count` paths; bit d of `Dimensions::pairs` is set if dimension
/// d is a pair. The values are those that the path's own sampler would return.
template <class Real, SamplerOf<Real> Sampler, uint32_t max_count, class Dimensions>
struct SampleBatch {
  Sampler samplers[max_count];
  uint32_t first_dimension[max_count]{};
  Real x[Dimensions::count][max_count], y[Dimensions::count][max_count];

  /// Generates the dimensions whose bit is set in `wanted`, for paths 0 to count - 1.
  ALHAZEN_INLINE void draw(uint32_t count, uint32_t wanted) {
    const uint32_t end = whole_rows(count);
    for (uint32_t d = 0; d < Dimensions::count; ++d) {
      if (!(wanted >> d & 1)) continue;
      if (Dimensions::pairs >> d & 1) {
        for (uint32_t i = 0; i < end; ++i) {
          const Vec2<Real> u = samplers[i].template get_2d<Real>(first_dimension[i] + d);
          x[d][i] = u.x;
          y[d][i] = u.y;
        }
      } else {
        for (uint32_t i = 0; i < end; ++i) x[d][i] = samplers[i].template get_1d<Real>(first_dimension[i] + d);
      }
    }
  }

  /// Dimension d of a path, as a pair or as one number.
  ALHAZEN_INLINE Vec2<Real> pair(uint32_t d, uint32_t path) const { return {x[d][path], y[d][path]}; }
  ALHAZEN_INLINE Real first(uint32_t d, uint32_t path) const { return x[d][path]; }

  /// Acts as the sampler of one path, for these dimensions only.
  struct One {
    const SampleBatch& all;
    uint32_t path;

    template <class>
    Real get_1d(uint32_t dimension) const {
      return all.first(dimension - all.first_dimension[path], path);
    }
    template <class>
    Vec2<Real> get_2d(uint32_t dimension) const {
      return all.pair(dimension - all.first_dimension[path], path);
    }
  };

  One of(uint32_t path) const { return {*this, path}; }
};

/// The random numbers of many paths, by dimension and path.
template <class Batch, class Real>
concept SampleBatchOf = requires(const Batch& batch, uint32_t dimension, uint32_t path) {
  { batch.pair(dimension, path) } -> std::same_as<Vec2<Real>>;
  { batch.first(dimension, path) } -> std::same_as<Real>;
};

}  // namespace ALHAZEN_CORE
