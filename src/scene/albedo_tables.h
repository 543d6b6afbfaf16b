#pragma once

// Computes the tables of core/materials/albedo_table.h. They depend on nothing but the index of an interface.

#include <vector>

namespace alhazen {

/// Those that come first, of GGX and sheen: AlbedoTables::interfaces values. Computed once.
const std::vector<double>& common_albedo_tables();

/// Of a rough dielectric interface of index `ior`, seen from outside: albedo_table_size values. Computed once an index.
const std::vector<double>& interface_albedo_table(double ior);

/// What a coat of index `ior` over a diffuse base lets through from a direction, absorption on the way down included:
/// albedo_table_size values. In place of the means stands the share of diffuse light from below that the interface
/// sends down again, absorbed on both ways. `conserves`: all that the interface does not reflect goes through;
/// otherwise what leaves its microfacets on the wrong side is lost, as in any model of single scattering.
std::vector<double> coat_transmission_table(double ior, double optical_thickness, bool conserves);

}  // namespace alhazen
