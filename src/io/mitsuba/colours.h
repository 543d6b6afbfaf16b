#pragma once

// Colours and spectra as the RGB variants of Mitsuba 3 have them, in linear sRGB.

#include "colour/spectrum.h"
#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

enum class ColourUse {
  reflectance,  ///< within [0, 1]
  unbounded,    ///< 0 or more: emission, indices of refraction
};

/// Whether a property is a colour: a number, rgb, a spectrum, or an object that is one everywhere.
bool is_constant_colour(const Build& build, const Property& property);

/// Such a colour. Throws InputError.
Vec3d colour_of(Build& build, const Property& property, ColourUse use);

/// The colour of property `name`, which must not be a texture, or `fallback`.
Vec3d colour(Build& build, ObjectReader& reader, std::string_view name, ColourUse use, const Vec3d& fallback);

/// The colour of a spectrum without white balance: Mitsuba integrates against the matching functions themselves, so
/// that a reflectance of 1 at all wavelengths is the white of equal energy, not of D65.
Vec3d equal_energy_rgb(const Spectrum& spectrum);

/// The spectrum of a property that is one; of a number, that value everywhere.
Spectrum spectrum_of(Build& build, const Property& property);

}  // namespace alhazen::impl::mitsuba
