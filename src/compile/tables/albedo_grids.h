#pragma once

// Computes the grids of core/materials/lobes/albedo_grid.h.

#include <cstdint>
#include <optional>

#include "compile/tables/table_cache.h"
#include "core/materials/lobes/albedo_grid.h"

namespace alhazen::impl {

/// The contents of a grid. `is_anisotropic` is false if the two alphas of the surface are equal at every point.
struct AlbedoGrid {
  enum class Kind {
    ggx,    ///< quantities as GgxGrid
    coat,   ///< as CoatGrid, of index `ior`
    glass,  ///< as GlassGrid, of index `ior`
    sheen   ///< its albedo for colour 1, alpha being the square of its roughness
  };
  Kind kind = Kind::ggx;
  double ior = 1.5;
  bool is_anisotropic = false;
  std::optional<double> alpha_u{}, alpha_v{};  ///< absent: they vary over the surface
  double thickness = 0;                        ///< coat: optical
  bool conserves = true;                       ///< coat: as in coat_transmission_table

  bool operator<(const AlbedoGrid& other) const;
};

/// The record, `first` left at 0.
AlbedoGridRecord record_of(const AlbedoGrid& grid);
/// Computed once per grid.
Table values_of(const AlbedoGrid& grid);

}  // namespace alhazen::impl
