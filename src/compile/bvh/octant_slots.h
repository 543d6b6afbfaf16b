#pragma once

// Assigns the children of an 8-wide node to slots, so that the direction of a ray determines the order of its visits
// (Ylitie, Karras, Laine 2017, section 3.3): slot s ^ octant is the priority of slot s, the
// lowest first, where `octant` has a bit for each axis along which the direction is negative.

#include <array>
#include <cmath>
#include <cstdint>

#include "core/math/vec.h"

namespace alhazen::impl {

/// Returns the slots of `count` children, given the offsets of their centres from the centre of the parent. Each child
/// takes the slot of its octant if that is free; the clearest cases choose first.
template <class Real>
std::array<uint32_t, 8> octant_slots(const Vec3<Real> (&offsets)[8], uint32_t count) {
  Real cost[8][8];
  for (uint32_t c = 0; c < count; ++c)
    for (uint32_t slot = 0; slot < 8; ++slot) {
      const Vec3<Real>& o = offsets[c];
      const Real sum = (slot & 1 ? -o.x : o.x) + (slot & 2 ? -o.y : o.y) + (slot & 4 ? -o.z : o.z);
      cost[c][slot] = std::isnan(sum) ? 0 : sum;  // of boxes beyond all bounds: it must not upset the order
    }
  std::array<uint32_t, 8> slots{};
  uint32_t left = (1u << count) - 1, used = 0;
  while (left != 0) {
    uint32_t best_child = 0, best_slot = 8;
    for (uint32_t c = 0; c < count; ++c) {
      if (!(left >> c & 1)) continue;
      for (uint32_t slot = 0; slot < 8; ++slot)
        if (!(used >> slot & 1) && (best_slot == 8 || cost[c][slot] < cost[best_child][best_slot])) {
          best_child = c;
          best_slot = slot;
        }
    }
    slots[best_child] = best_slot;
    left &= ~(1u << best_child);
    used |= 1u << best_slot;
  }
  return slots;
}

}  // namespace alhazen::impl
