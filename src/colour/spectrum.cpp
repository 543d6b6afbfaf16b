#include "colour/spectrum.h"

#include <algorithm>
#include <cmath>

#include "colour/cie_1931.h"
#include "colour/rgb_space.h"

namespace alhazen::impl {

double Spectrum::at(double nanometres) const {
  const auto after = std::upper_bound(wavelengths.begin(), wavelengths.end(), nanometres);
  if (after == wavelengths.begin()) return 0;
  const size_t i = static_cast<size_t>(after - wavelengths.begin()) - 1;
  if (nanometres == wavelengths[i]) return values[i];
  if (after == wavelengths.end()) return 0;
  const double t = (nanometres - wavelengths[i]) / (wavelengths[i + 1] - wavelengths[i]);
  return (1 - t) * values[i] + t * values[i + 1];
}

Spectrum constant_spectrum(double value) { return {{double{first_visible}, double{last_visible}}, {value, value}}; }

Spectrum blackbody_spectrum(double kelvin) {
  // CODATA 2018, exact: second radiation constant h c / k, and Wien's displacement constant; both in nm K.
  constexpr double second_radiation = 1.438776877e7, wien = 2.897771955e6;
  // Colder bodies emit nothing in the visible range that a double could represent.
  constexpr double coldest = 10;
  const bool glows = std::isfinite(kelvin) && kelvin >= coldest;
  Spectrum spectrum;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) {
    // Relative to the maximum of Planck's law, which may be outside the visible range.
    const double x = 1 / (nanometres * kelvin);
    const double of_peak =
        std::pow(wien * x, 5) * std::expm1(second_radiation / wien) / std::expm1(second_radiation * x);
    spectrum.wavelengths.push_back(nanometres);
    spectrum.values.push_back(glows ? of_peak : 0);
  }
  return spectrum;
}

namespace {

/// The sum over 1 nm steps of `weight(nanometres)` times the colour matching functions.
template <class Weight>
Vec3d integrate(const Weight& weight) {
  Vec3d xyz;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres)
    xyz += cie_1931(nanometres) * weight(nanometres);
  return xyz;
}

const Spectrum& d65() {
  static const Spectrum& spectrum = *named_spectrum("stdillum-D65");
  return spectrum;
}

Vec3d srgb_under_d65(const Spectrum& reflectance) {
  return xyz_to_srgb(integrate([&](int nanometres) { return reflectance.at(nanometres) * d65().at(nanometres); }));
}

}  // namespace

Vec3d reflectance_rgb(const Spectrum& reflectance) {
  // Divides each channel by that of white. The matrix alone leaves an error of 1e-5, since its white has four digits.
  static const Vec3d white = srgb_under_d65(constant_spectrum(1));
  return srgb_under_d65(reflectance) / white;
}

Vec3d illuminant_rgb(const Spectrum& emission) {
  const Vec3d xyz = integrate([&](int nanometres) { return emission.at(nanometres); });
  return xyz.y > 0 ? xyz_to_srgb(xyz / splat(xyz.y)) : Vec3d{};
}

}  // namespace alhazen::impl
