// Looks up spectra by name.

#include <map>
#include <string_view>

#include "colour/cie_1931.h"
#include "colour/named_tables.h"
#include "colour/spectrum.h"

namespace alhazen::impl {

namespace {

using SpectraByName = std::map<std::string_view, Spectrum>;

/// Tables that end within the visible range are extended to its ends with their last values, as in pbrt-v4.
Spectrum spectrum_of(const NamedTable& table) {
  Spectrum spectrum;
  const auto add = [&](double wavelength, double value) {
    spectrum.wavelengths.push_back(wavelength);
    spectrum.values.push_back(value);
  };
  if (table.wavelength(0) > first_visible) add(first_visible, table.values.front());
  for (size_t i = 0; i < table.values.size(); ++i) add(table.wavelength(i), table.values[i]);
  if (spectrum.wavelengths.back() < last_visible) add(last_visible, table.values.back());
  return spectrum;
}

SpectraByName all_spectra() {
  SpectraByName spectra;
  for (const auto& tables : {illuminant_tables(), metal_tables(), glass_tables()})
    for (const NamedTable& table : tables) spectra.emplace(table.name, spectrum_of(table));
  return spectra;
}

}  // namespace

const Spectrum* named_spectrum(const std::string& name) {
  static const SpectraByName spectra = all_spectra();
  const auto found = spectra.find(name);
  return found == spectra.end() ? nullptr : &found->second;
}

}  // namespace alhazen::impl
