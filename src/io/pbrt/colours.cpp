#include "io/pbrt/colours.h"

#include <filesystem>

#include "colour/rgb_space.h"

namespace alhazen::impl::pbrt {

namespace {

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

Vec3d three_numbers(const Parameter& parameter) {
  const auto& values = std::get<Numbers>(parameter.values);
  if (values.size() != 3)
    fail(parameter.place, quoted(parameter.name) + " takes three values, got " + std::to_string(values.size()));
  return {values[0], values[1], values[2]};
}

Vec3d rgb_of(const Parameter& parameter, ColourUse use) {
  const Vec3d rgb = three_numbers(parameter);
  if (rgb.x < 0 || rgb.y < 0 || rgb.z < 0)
    fail(parameter.place, quoted(parameter.name) + ": a colour cannot be negative");
  if (use == ColourUse::albedo && max_component(rgb) > 1)
    fail(parameter.place, quoted(parameter.name) + ": a reflectance cannot be over 1");
  return to_srgb(parameter.rgb_space, rgb);
}

Spectrum listed_spectrum(const Parameter& parameter, const Numbers& values) {
  if (values.size() % 2 != 0)
    fail(parameter.place, quoted(parameter.name) + ": expected pairs of wavelength and value, got " +
                              std::to_string(values.size()) + " numbers");
  Spectrum spectrum;
  for (size_t i = 0; i < values.size(); i += 2) {
    if (i > 0 && !(values[i] > values[i - 2]))
      fail(parameter.place, quoted(parameter.name) + ": the wavelengths must increase from pair to pair");
    spectrum.wavelengths.push_back(values[i]);
    spectrum.values.push_back(values[i + 1]);
  }
  return spectrum;
}

Spectrum spectrum_by_name(const Build& build, const Parameter& parameter, const Strings& names) {
  if (names.size() != 1) fail(parameter.place, quoted(parameter.name) + " takes one spectrum");
  if (const Spectrum* known = named_spectrum(names[0])) return *known;
  if (!std::filesystem::path(names[0]).has_extension())
    fail(parameter.place, quoted(parameter.name) + ": no spectrum is named " + quoted(names[0]) +
                              "; known are metal-*-eta, metal-*-k, glass-* and stdillum-*, or give a .spd file");
  const InputPath path = build.existing_file(parameter.place, names[0]);
  const auto known = build.spectra_by_file.find(path.name);
  if (known != build.spectra_by_file.end()) return known->second;
  return build.spectra_by_file.emplace(path.name, read_spectrum(path)).first->second;
}

double kelvin_of(const Parameter& parameter) {
  const auto& values = std::get<Numbers>(parameter.values);
  if (values.size() != 1 || !(values[0] > 0))
    fail(parameter.place, quoted(parameter.name) + ": a blackbody takes one temperature in kelvin, over 0");
  return values[0];
}

}  // namespace

std::optional<Spectrum> spectrum_of(const Build& build, const Parameter& parameter) {
  if (parameter.type == ParameterType::blackbody) return blackbody_spectrum(kelvin_of(parameter));
  if (parameter.type != ParameterType::spectrum) return {};
  if (const auto* names = std::get_if<Strings>(&parameter.values)) return spectrum_by_name(build, parameter, *names);
  return listed_spectrum(parameter, std::get<Numbers>(parameter.values));
}

Vec3d colour_of(const Build& build, const Parameter& parameter, ColourUse use) {
  const auto projected = [&] {
    if (parameter.type == ParameterType::rgb) return rgb_of(parameter, use);
    if (parameter.type == ParameterType::xyz) return xyz_to_srgb(three_numbers(parameter));
    const Spectrum spectrum = *spectrum_of(build, parameter);
    return use == ColourUse::illuminant ? illuminant_rgb(spectrum) : reflectance_rgb(spectrum);
  };
  const Vec3d rgb = projected();
  if (!is_finite(rgb)) fail(parameter.place, quoted(parameter.name) + " is not a finite colour in linear sRGB");
  return rgb;
}

Vec3d colour(const Build& build, ParameterList& list, std::string_view name, ColourUse use, const Vec3d& fallback) {
  const Parameter* parameter = list.find(name, colour_types);
  return parameter ? colour_of(build, *parameter, use) : fallback;
}

}  // namespace alhazen::impl::pbrt
