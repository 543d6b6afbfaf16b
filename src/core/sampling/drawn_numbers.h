#pragma once

// Random numbers of many paths, drawn side by side: the loops are plain enough for compilers to turn into SIMD
// instructions, which hashes like very much.

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// `dimensions` draws for each of up to `most` paths. They are those that the path's own sampler would return.
template <class Real, class Sampler, uint32_t most, uint32_t dimensions>
struct DrawnNumbers {
  Sampler samplers[most];
  uint32_t first_dimension[most];
  Real x[dimensions][most], y[dimensions][most];

  /// Draws for paths 0 to count - 1.
  void draw(uint32_t count) {
    for (uint32_t d = 0; d < dimensions; ++d)
      for (uint32_t i = 0; i < count; ++i) {
        const Vec2<Real> u = samplers[i].template get_2d<Real>(first_dimension[i] + d);
        x[d][i] = u.x;
        y[d][i] = u.y;
      }
  }

  /// Stands for the sampler of one path, of which only these dimensions may be asked.
  struct One {
    const DrawnNumbers& all;
    uint32_t path;

    /// Where one number is wanted, every sampler draws the first of the pair.
    template <class>
    Real get_1d(uint32_t dimension) const {
      return all.x[dimension - all.first_dimension[path]][path];
    }
    template <class>
    Vec2<Real> get_2d(uint32_t dimension) const {
      const uint32_t d = dimension - all.first_dimension[path];
      return {all.x[d][path], all.y[d][path]};
    }
  };

  One of(uint32_t path) const { return {*this, path}; }
};

}  // namespace ALHAZEN_CORE
