#pragma once

// Assigns random numbers to their uses. A dimension is one number or one pair.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

struct CameraDimensions {
  static constexpr uint32_t film = 0;  ///< pair
  static constexpr uint32_t lens = 1;  ///< pair
  static constexpr uint32_t time = 2;
  static constexpr uint32_t count = 3;
  static constexpr uint32_t pairs = 0b011;  ///< bit d: dimension d is a pair
};

/// The dimensions of one vertex of a path; `vertex` 0 is the first surface that the camera ray hits.
struct VertexDimensions {
  static constexpr uint32_t count = 4;
  static constexpr uint32_t pairs = 0b0110;  ///< bit d: dimension base + d is a pair
  uint32_t base;

  ALHAZEN_HD explicit constexpr VertexDimensions(uint32_t vertex) : base(CameraDimensions::count + count * vertex) {}
  ALHAZEN_HD static constexpr VertexDimensions from(uint32_t base) {
    VertexDimensions dimensions(0);
    dimensions.base = base;
    return dimensions;
  }
  ALHAZEN_HD constexpr uint32_t bsdf_lobe() const { return base; }
  ALHAZEN_HD constexpr uint32_t bsdf_direction() const { return base + 1; }  ///< pair
  ALHAZEN_HD constexpr uint32_t light() const { return base + 2; }           ///< pair
  ALHAZEN_HD constexpr uint32_t roulette() const { return base + 3; }
};

}  // namespace ALHAZEN_CORE
