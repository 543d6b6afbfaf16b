#pragma once

// Random numbers of many paths, drawn side by side: the loops are plain enough for compilers to turn into SIMD
// instructions, which hashes like very much.

#include "core/math/vec.h"
#include "core/simd/columns.h"

namespace ALHAZEN_CORE {

/// Draws for each of up to `most` paths, `Dimensions::count` of them; bit d of `Dimensions::pairs` says that draw d is
/// one of a pair. They are those that the path's own sampler would return.
template <class Real, class Sampler, uint32_t most, class Dimensions>
struct DrawnNumbers {
  Sampler samplers[most];
  uint32_t first_dimension[most]{};
  Real x[Dimensions::count][most], y[Dimensions::count][most];

  /// Draws for paths 0 to count - 1, where bit d of `wanted` says whether draw d is.
  void draw(uint32_t count, uint32_t wanted) {
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

  /// Draw d of a path, which is a pair, or one number.
  ALHAZEN_INLINE Vec2<Real> pair(uint32_t d, uint32_t path) const { return {x[d][path], y[d][path]}; }
  ALHAZEN_INLINE Real first(uint32_t d, uint32_t path) const { return x[d][path]; }

  /// Stands for the sampler of one path, of which only these dimensions may be asked.
  struct One {
    const DrawnNumbers& all;
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

}  // namespace ALHAZEN_CORE
