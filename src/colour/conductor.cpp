// Metals: converts spectra of eta and k to three channels with the same reflectance.

#include <algorithm>
#include <cmath>

#include "colour/cie_1931.h"
#include "colour/rgb_space.h"
#include "colour/spectrum.h"

namespace alhazen::impl {

namespace {

/// Total reflection would need an infinite k.
constexpr double max_reflectance = 0.9999;

/// Measurements may end within the visible range; their last value is used beyond, where the eye is hardly sensitive.
double held(const Spectrum& spectrum, double nanometres) {
  if (spectrum.wavelengths.empty()) return 0;
  return spectrum.at(std::clamp(nanometres, spectrum.wavelengths.front(), spectrum.wavelengths.back()));
}

/// Fresnel reflectance at normal incidence from vacuum.
double normal_reflectance(double eta, double k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

Spectrum normal_reflectance(const Spectrum& eta, const Spectrum& k) {
  Spectrum reflectance;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) {
    reflectance.wavelengths.push_back(nanometres);
    reflectance.values.push_back(normal_reflectance(held(eta, nanometres), held(k, nanometres)));
  }
  return reflectance;
}

/// The mean of eta weighted by each channel's sensitivity under D65; negative sensitivities are ignored.
Vec3d mean_by_channel(const Spectrum& eta) {
  const Spectrum& d65 = *named_spectrum("stdillum-D65");
  Vec3d sum, total;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) {
    const Vec3d sensitivity = max(xyz_to_srgb(cie_1931(nanometres)), Vec3d{}) * d65.at(nanometres);
    sum += sensitivity * held(eta, nanometres);
    total += sensitivity;
  }
  return sum / total;
}

/// Sets k so that `eta` and `k` reflect `reflectance` at normal incidence; if eta alone reflects more than that, k is 0
/// and eta is changed.
void match_reflectance(double reflectance, double& eta, double& k) {
  const double k_squared = (reflectance * (eta + 1) * (eta + 1) - (eta - 1) * (eta - 1)) / (1 - reflectance);
  if (k_squared >= 0) {
    k = std::sqrt(k_squared);
    return;
  }
  k = 0;
  const double root = std::sqrt(reflectance);
  eta = eta > 1 ? (1 + root) / (1 - root) : (1 - root) / (1 + root);
}

}  // namespace

ConductorRgb conductor_rgb(const Spectrum& eta, const Spectrum& k) {
  const Vec3d reflectance = reflectance_rgb(normal_reflectance(eta, k));
  ConductorRgb rgb{mean_by_channel(eta), {}};
  for (int channel = 0; channel < 3; ++channel)
    match_reflectance(std::clamp(reflectance[channel], 0.0, max_reflectance), rgb.eta[channel], rgb.k[channel]);
  return rgb;
}

}  // namespace alhazen::impl
