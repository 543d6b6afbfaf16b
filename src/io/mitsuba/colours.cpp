#include "io/mitsuba/colours.h"

#include <cmath>
#include <set>

#include "colour/cie_1931.h"
#include "colour/rgb_space.h"
#include "io/mitsuba/attributes.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

/// Objects that are one colour everywhere.
const std::set<std::string_view> constant_types{"uniform", "srgb", "rgb", "d65", "blackbody"};

void add_sample(Spectrum& spectrum, double wavelength, double value, const Property& property) {
  if (!spectrum.wavelengths.empty() && !(wavelength > spectrum.wavelengths.back()))
    fail(property.place, quoted(property.name) + ": the wavelengths must increase from pair to pair");
  spectrum.wavelengths.push_back(wavelength);
  spectrum.values.push_back(value);
}

bool is_uniform(const Property& property) {
  return property.kind == ValueKind::spectrum && property.text.find(':') == std::string::npos;
}

Spectrum listed_spectrum(const Property& property) {
  Spectrum spectrum;
  const std::string what = quoted(property.name);
  for (const std::string_view word : words_of(property.text)) {
    const size_t colon = word.find(':');
    if (colon == std::string_view::npos)
      fail(property.place, what + " takes one number, or pairs as 400:0.5, 700:0.7, not " + quoted(word));
    add_sample(spectrum, parse_finite(word.substr(0, colon), property.place, what),
               parse_finite(word.substr(colon + 1), property.place, what), property);
  }
  return spectrum;
}

/// Planck's law in W / (m^2 sr nm).
Spectrum absolute_blackbody(double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23, metres = 560e-9;
  const double radiance = 1e-9 * 2 * h * c * c / (std::pow(metres, 5) * std::expm1(h * c / (metres * k * kelvin)));
  Spectrum spectrum = blackbody_spectrum(kelvin);
  const double factor = radiance / spectrum.at(560);
  for (double& value : spectrum.values) value *= factor;
  return spectrum;
}

Vec3d colour_of_object(Build& build, uint32_t index) {
  ObjectReader reader(build.document, index);
  const std::string& type = reader.object().type;
  Vec3d rgb{};
  if (type == "uniform")
    rgb = splat(reader.number("value", 1));
  else if (type == "d65")
    rgb = splat(reader.number("scale", 1));
  else if (type == "blackbody")
    rgb = equal_energy_rgb(absolute_blackbody(reader.positive("temperature", 5000))) * reader.number("scale", 1);
  else
    rgb = colour(build, reader, reader.has("color") ? "color" : "value", ColourUse::unbounded, {1, 1, 1});
  reader.ignore({"wavelength_min", "wavelength_max", "unbounded"});
  reader.reject_unknown();
  return rgb;
}

Vec3d unchecked_colour(Build& build, const Property& property) {
  switch (property.kind) {
    case ValueKind::number:
    case ValueKind::integer:
      return splat(property.number);
    case ValueKind::rgb:
      return property.vector;
    case ValueKind::spectrum:
      if (is_uniform(property)) return splat(parse_finite(property.text, property.place, quoted(property.name)));
      return equal_energy_rgb(listed_spectrum(property));
    case ValueKind::spectrum_file:
      return equal_energy_rgb(spectrum_of(build, property));
    case ValueKind::object:
      if (is_constant_colour(build, property)) return colour_of_object(build, property.object);
      break;
    default:
      break;
  }
  fail(property.place,
       quoted(property.name) + " must be a colour that is the same everywhere: <rgb>, <spectrum> or <float>");
}

}  // namespace

Vec3d equal_energy_rgb(const Spectrum& spectrum) {
  Vec3d xyz{};
  double luminous = 0;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) {
    const Vec3d matching = cie_1931(nanometres);
    xyz += matching * spectrum.at(nanometres);
    luminous += matching.y;
  }
  return max(xyz_to_srgb(xyz / luminous), Vec3d{});
}

bool is_constant_colour(const Build& build, const Property& property) {
  return property.kind != ValueKind::object || constant_types.contains(build.object(property).type);
}

Spectrum spectrum_of(Build& build, const Property& property) {
  if (property.kind == ValueKind::spectrum_file)
    return read_spectrum(build.document.existing_file(property.place, property.text));
  if (property.kind == ValueKind::spectrum && !is_uniform(property)) return listed_spectrum(property);
  return constant_spectrum(unchecked_colour(build, property).x);
}

Vec3d colour_of(Build& build, const Property& property, ColourUse use) {
  const Vec3d rgb = unchecked_colour(build, property);
  const std::string what = quoted(property.name);
  if (!is_finite(rgb)) fail(property.place, what + " is not a finite colour");
  if (rgb.x < 0 || rgb.y < 0 || rgb.z < 0) fail(property.place, what + ": a colour cannot be negative");
  if (use == ColourUse::unbounded || max_component(rgb) <= 1) return rgb;
  if (property.kind != ValueKind::spectrum && property.kind != ValueKind::spectrum_file)
    fail(property.place, what + ": a reflectance cannot be over 1");
  return min(rgb, Vec3d{1, 1, 1});  // spectra may be outside the gamut of sRGB
}

Vec3d colour(Build& build, ObjectReader& reader, std::string_view name, ColourUse use, const Vec3d& fallback) {
  const Property* property = reader.find(name);
  return property ? colour_of(build, *property, use) : fallback;
}

}  // namespace alhazen::impl::mitsuba
