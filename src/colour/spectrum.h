#pragma once

// Spectra as given in scene files, and their conversion to linear sRGB.

#include <string>
#include <vector>

#include "core/math/vec.h"
#include "files/input_file.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Piecewise linear over ascending wavelengths in nanometres; zero outside its range.
struct Spectrum {
  std::vector<double> wavelengths;
  std::vector<double> values;

  double at(double nanometres) const;
};

/// A spectrum that is `value` everywhere from 360 to 830 nm.
Spectrum constant_spectrum(double value);

/// Planck's law at `kelvin`, scaled to a maximum of 1.
Spectrum blackbody_spectrum(double kelvin);

/// Linear sRGB of a reflectance (or transmittance, or any unbounded factor) seen under D65: constant 1 is (1, 1, 1).
Vec3d reflectance_rgb(const Spectrum& reflectance);

/// Linear sRGB of an emission spectrum, scaled to luminance 1, as pbrt-v4 does for the spectra of lights.
Vec3d illuminant_rgb(const Spectrum& emission);

struct ConductorRgb {
  Vec3d eta;
  Vec3d k;
};

/// Index of refraction and absorption for each of the three channels such that the reflectance at normal incidence is
/// the sRGB projection of the spectral one. Negative (out-of-gamut) channels are raised to 0.
ConductorRgb conductor_rgb(const Spectrum& eta, const Spectrum& k);

/// The spectra that pbrt-v4 defines by name: metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2}-{eta,k},
/// glass-{BK7,BAF10,FK51A,LASF9,F5,F10,F11}, stdillum-{A,D50,D65,F1..F12}, as far as they are available.
/// Null if the name is unknown.
const Spectrum* named_spectrum(const std::string& name);

/// Reads a text file of wavelength and value pairs (`.spd`); `#` starts a comment. Throws InputError.
Spectrum read_spectrum(const InputPath& path);

}  // namespace alhazen::impl
