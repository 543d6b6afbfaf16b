#pragma once

// How much of a pixel each object, or each material, covers: what Cryptomatte stores (Friedman and Jones 2015, "Fully
// Automatic ID Mattes with Support for Motion Blur and Transparency").

#include "core/math/platform.h"
#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

/// Sums of filter weights by id. Where there are more ids than slots, those of the smallest weights are lost.
template <class Real>
struct Coverage {
  static constexpr uint32_t slots = 10;

  uint32_t ids[slots]{};  ///< then no_id
  Real weights[slots]{};
  Real total = 0;  ///< of all samples, also of those that hit nothing

  ALHAZEN_HD void add(uint32_t id, Real weight) {
    total += weight;
    if (id == no_id) return;
    uint32_t smallest = 0;
    for (uint32_t k = 0; k < slots; ++k) {
      if (ids[k] == no_id) ids[k] = id;
      if (ids[k] == id) {
        weights[k] += weight;
        return;
      }
      if (weights[k] < weights[smallest]) smallest = k;
    }
    if (!(weights[smallest] <= weight)) return;
    ids[smallest] = id;
    weights[smallest] = weight;
  }
};

}  // namespace ALHAZEN_CORE
