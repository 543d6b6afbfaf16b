#pragma once

// The tables of albedo that a scene's materials share: each is stored once, however many materials ask for it.

#include <cstdint>
#include <map>
#include <tuple>

#include "compile/scene_arrays.h"
#include "compile/tables/albedo_grids.h"
#include "compile/tables/albedo_tables.h"
#include "compile/tables/coated_metal_tables.h"

namespace alhazen::impl {

/// Each function returns where a table is in SceneView::albedo_tables, and computes it when it is first asked for.
template <class Real>
class StoredTables {
 public:
  explicit StoredTables(SceneArrays<Real>& out) : out_(out) {}

  AlbedoGridRecord grid(const AlbedoGrid& grid) {
    const auto [entry, is_new] = grids_.try_emplace(grid);
    if (is_new) {
      entry->second = record_of(grid);
      entry->second.first = append(values_of(grid));
    }
    return entry->second;
  }

  /// What an interface of that index reflects.
  uint32_t interface(double ior) {
    const auto [entry, is_new] = interfaces_.try_emplace(ior);
    if (is_new) entry->second = append(interface_albedo_table(ior));
    return entry->second;
  }

  /// What a coat lets through to a diffuse base.
  uint32_t transmission(double ior, double thickness, bool conserves) {
    const auto [entry, is_new] = transmissions_.try_emplace({ior, thickness, conserves});
    if (is_new) entry->second = append(coat_transmission_table(ior, thickness, conserves));
    return entry->second;
  }

  uint32_t coated_metal(const CoatedMetal& coat) {
    const auto [entry, is_new] = coated_metals_.try_emplace(coat);
    if (is_new) entry->second = append(coated_metal_table(coat));
    return entry->second;
  }

 private:
  uint32_t append(const Table& table) {
    const auto first = static_cast<uint32_t>(out_.albedo_tables.size());
    for (const double value : *table) out_.albedo_tables.push_back(static_cast<Real>(value));
    return first;
  }

  SceneArrays<Real>& out_;
  std::map<AlbedoGrid, AlbedoGridRecord> grids_;
  std::map<double, uint32_t> interfaces_;
  std::map<std::tuple<double, double, bool>, uint32_t> transmissions_;
  std::map<CoatedMetal, uint32_t> coated_metals_;
};

}  // namespace alhazen::impl
