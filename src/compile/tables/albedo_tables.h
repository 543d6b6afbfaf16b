#pragma once

// Computes the tables of core/materials/lobes/albedo_table.h. They depend on the coat alone.

#include "compile/tables/table_cache.h"
#include "core/materials/lobes/albedo_table.h"

namespace alhazen::impl {

inline constexpr uint32_t coat_transmission_size = (albedo_side + CoatColumns::count) * albedo_side;

/// For a rough dielectric interface of index `ior`, seen from outside: albedo_table_size values. Computed once per
/// index.
Table interface_albedo_table(double ior);

/// Transmission of a coat of index `ior` over a diffuse base, by direction, including absorption on the way down,
/// followed by the values of CoatColumns: coat_transmission_size values. If `conserves`, the interface transmits all
/// that it does not reflect; otherwise light that leaves its microfacets on the wrong side is lost, as in any
/// single-scattering model. Computed once per coat.
Table coat_transmission_table(double ior, double optical_thickness, bool conserves);

}  // namespace alhazen::impl
