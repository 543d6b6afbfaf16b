#pragma once

// Reads colours and spectra from parameters.

#include <optional>
#include <string>

#include "colour/spectrum.h"
#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

enum class ColourUse {
  albedo,      ///< within [0, 1]
  illuminant,  ///< of a light: spectra are scaled to luminance 1, rgb is used as given
  unbounded,   ///< any factor of 0 or more
};

/// The parameter types that specify a colour.
inline constexpr std::initializer_list<ParameterType> colour_types{ParameterType::rgb, ParameterType::spectrum,
                                                                   ParameterType::xyz, ParameterType::blackbody};

/// Linear sRGB of a parameter of one of the colour types.
Vec3d colour_of(const Build& build, const Parameter& parameter, ColourUse use);

/// Linear sRGB of parameter `name`, or `fallback`.
Vec3d colour(const Build& build, ParameterList& list, std::string_view name, ColourUse use, const Vec3d& fallback);

/// The spectrum of a parameter of type spectrum or blackbody; absent for the other types.
std::optional<Spectrum> spectrum_of(const Build& build, const Parameter& parameter);

}  // namespace alhazen::impl::pbrt
