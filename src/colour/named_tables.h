#pragma once

// The tables of named_spectrum() as stored in the data files.

#include <array>
#include <span>
#include <string_view>

namespace alhazen::impl {

struct NamedTable {
  std::string_view name;
  std::span<const double> wavelengths;  ///< nanometres; empty for a regular table
  std::span<const double> values;
  double first = 0, step = 0;  ///< nanometres, of a regular table

  static constexpr NamedTable regular(std::string_view name, double first, double step,
                                      std::span<const double> values) {
    return {name, {}, values, first, step};
  }
  double wavelength(size_t i) const {
    return wavelengths.empty() ? first + step * static_cast<double>(i) : wavelengths[i];
  }
};

std::span<const NamedTable> illuminant_tables();
std::span<const NamedTable> metal_tables();
std::span<const NamedTable> glass_tables();

}  // namespace alhazen::impl
