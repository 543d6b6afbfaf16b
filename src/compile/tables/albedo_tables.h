#pragma once

// Computes the tables of core/materials/lobes/albedo_table.h. They depend on nothing but a coat.

#include "compile/tables/table_cache.h"
#include "core/materials/lobes/albedo_table.h"

namespace alhazen {

inline constexpr uint32_t coat_transmission_size = (albedo_side + CoatColumns::count) * albedo_side;

/// Of a rough dielectric interface of index `ior`, seen from outside: albedo_table_size values. Computed once an index.
Table interface_albedo_table(double ior);

/// What a coat of index `ior` over a diffuse base lets through from a direction, absorption on the way down included,
/// and after the rows what CoatColumns says: coat_transmission_size values. `conserves`: all that the interface does
/// not reflect goes through; otherwise what leaves its microfacets on the wrong side is lost, as in any model of single
/// scattering. Computed once a coat.
Table coat_transmission_table(double ior, double optical_thickness, bool conserves);

}  // namespace alhazen
