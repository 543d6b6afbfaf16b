#pragma once

// Computes the tables of core/materials/lobes/coated_metal.h.

#include <optional>

#include "compile/tables/table_cache.h"

namespace alhazen::impl {

struct CoatedMetal {
  double ior = 1.5;
  std::optional<double> coat_alpha, metal_alpha;  ///< absent: they vary over the surface
  double thickness = 0;                           ///< optical
  int bounces = 0;                                ///< maximum number of bounces off the metal; 0: no limit

  bool operator<(const CoatedMetal& other) const;
};

/// Scales for GGX of coated_metal_alpha that give it the albedo of a random walk between the two surfaces, each of
/// which scatters once per visit. Computed once per coat.
Table coated_metal_table(const CoatedMetal& coat);

}  // namespace alhazen::impl
