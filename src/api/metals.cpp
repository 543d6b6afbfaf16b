#include "api/metals.h"

#include <array>
#include <string>

#include "api/arguments.h"

namespace alhazen::impl {

ConductorRgb metal_rgb(alhazen::Metal metal) {
  constexpr std::array<const char*, 7> symbols{"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"};
  const auto number = same_kind<uint32_t>("metal", metal, symbols.size());
  const std::string name = std::string("metal-") + symbols[number];
  const Spectrum *eta = named_spectrum(name + "-eta"), *k = named_spectrum(name + "-k");
  if (!eta || !k) refuse_argument("metal", "has no spectra in this build");
  return conductor_rgb(*eta, *k);
}

}  // namespace alhazen::impl

namespace ALHAZEN_NAMESPACE {

Conductor Conductor::of(Metal metal, const Roughness& roughness) {
  const impl::ConductorRgb rgb = impl::metal_rgb(metal);
  return {
      .reflectance = {}, .eta = impl::public_colour(rgb.eta), .k = impl::public_colour(rgb.k), .roughness = roughness};
}

}  // namespace ALHAZEN_NAMESPACE
