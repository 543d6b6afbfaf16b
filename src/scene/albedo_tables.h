#pragma once

// Computes the tables of core/materials/albedo_table.h. They depend on nothing but the index of an interface.

#include <vector>

namespace alhazen {

/// Those that come first, of GGX and sheen: AlbedoTables::interfaces values. Computed once.
const std::vector<double>& common_albedo_tables();

/// Of a rough dielectric interface of index `ior`, seen from outside: albedo_table_size values. Computed once an index.
const std::vector<double>& interface_albedo_table(double ior);

/// Share of diffuse light that a smooth interface of index `ior` sends back inside, after a way to and fro through a
/// layer of that optical thickness.
double inner_diffuse_reflectance(double ior, double optical_thickness);

}  // namespace alhazen
