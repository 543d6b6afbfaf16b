#pragma once

// Computes the tables of core/materials/coated_metal.h.

#include <optional>

#include "compile/tables/table_cache.h"

namespace alhazen {

struct CoatedMetal {
  double ior = 1.5;
  std::optional<double> coat_alpha, metal_alpha;  ///< absent: they vary over the surface
  double thickness = 0;                           ///< optical
  int bounces = 0;                                ///< light meets the metal as often as this at most; 0: for ever

  bool operator<(const CoatedMetal& other) const;
};

/// Scales for GGX of coated_metal_alpha, so that its albedo is that of a random walk between the two surfaces, in which
/// each scatters once a visit. Computed once a coat.
Table coated_metal_table(const CoatedMetal& coat);

}  // namespace alhazen
