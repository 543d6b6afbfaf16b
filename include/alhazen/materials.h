#pragma once

// Materials. Each kind is a struct with defaults: `scene.add(Principled{.base_colour = {0.8, 0.1, 0.1}})`. Colours that
// are reflectances are from 0 to 1.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "alhazen/alternative.h"
#include "alhazen/textures.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Roughness of a microfacet surface: 0 is smooth. One value, or one along u and another along v.
struct Roughness {
  NumberInput u = 0, v = 0;
  bool remap = true;  ///< alpha = sqrt(roughness), as in pbrt; otherwise alpha = roughness

  Roughness() = default;
  Roughness(double both) : u(both), v(both) {}     // NOLINT: the same in all directions
  Roughness(TextureId both) : u(both), v(both) {}  // NOLINT
  Roughness(NumberInput along_u, NumberInput along_v) : u(along_u), v(along_v) {}
  friend bool operator==(const Roughness&, const Roughness&) = default;
};

struct Diffuse {
  ColourInput reflectance = 0.5;
  NumberInput roughness = 0;  ///< 0: Lambert; up to 1: Oren-Nayar
};

/// Metals whose indices of refraction are built in.
enum class Metal { silver, aluminium, gold, copper, brass, magnesium_oxide, titanium_dioxide };

/// A metal: by its reflectance, or by its index of refraction eta and absorption coefficient k for red, green and blue.
/// Without any it is copper.
struct Conductor {
  std::optional<ColourInput> reflectance{};
  std::optional<ColourInput> eta{}, k{};
  Roughness roughness{};

  /// One with the measured eta and k of `metal`.
  static Conductor of(Metal metal, const Roughness& roughness = {});
};

/// Glass and the like: a surface that bounds a volume.
struct Dielectric {
  double ior = 1.5;  ///< index of refraction inside relative to outside
  Roughness roughness{};
  Colour absorption{0};  ///< of the volume, per scene unit
};

/// A pane of glass: both of its surfaces in one.
struct ThinDielectric {
  double ior = 1.5;
};

/// A diffuse surface under a dielectric coat.
struct CoatedDiffuse {
  ColourInput reflectance = 0.5;
  double ior = 1.5;
  Roughness roughness{};  ///< of the coat
  /// Optical thickness of the coat. Absent: 0.01 with RenderDefaults::pbrt_coats, otherwise 0.
  std::optional<double> thickness{};
  int bounces = 5;  ///< with RenderDefaults::pbrt_coats, the most at the base; 0: no limit
};

/// A metal under a dielectric coat.
struct CoatedConductor {
  std::optional<ColourInput> reflectance{};  ///< as of Conductor
  std::optional<ColourInput> eta{}, k{};
  Roughness roughness{};  ///< of the metal
  double coat_ior = 1.5;
  NumberInput coat_roughness = 0;
  std::optional<double> thickness{};  ///< as of CoatedDiffuse
  int bounces = 5;
};

/// Paper, leaves: reflects and transmits diffusely.
struct DiffuseTransmission {
  ColourInput reflectance = 0.25, transmittance = 0.25;
};

/// One of two materials at each point, at random with the probability `amount` of the second.
struct Mix {
  std::array<MaterialId, 2> materials{};
  NumberInput amount = 0.5;
};

/// Metals, plastics, glass, cloth and car paint in one: glTF's metallic-roughness model with its extensions.
struct Principled {
  ColourInput base_colour = 0.8;
  NumberInput metallic = 0;
  NumberInput roughness = 0.5;      ///< alpha = roughness^2
  NumberInput specular = 1;         ///< factor on the dielectric's reflection
  ColourInput specular_colour = 1;  ///< factor on it at normal incidence
  double ior = 1.5;
  NumberInput transmission = 0;  ///< fraction of the light not reflected by the base that is refracted
  /// Transmission without refraction: the surface is a thin sheet. Otherwise it bounds a volume.
  bool thin = false;
  Colour attenuation_colour{1};  ///< what is left of white light after `attenuation_distance` (scene units) within it
  double attenuation_distance = std::numeric_limits<double>::infinity();
  double dispersion = 0;  ///< 20 / Abbe number, not negative
  NumberInput clearcoat = 0, clearcoat_roughness = 0;
  TextureId clearcoat_normal_map{};
  double clearcoat_normal_scale = 1;
  ColourInput sheen_colour = 0;
  NumberInput sheen_roughness = 0;
  NumberInput iridescence = 0;
  NumberInput iridescence_thickness = 400;  ///< nanometres
  double iridescence_ior = 1.3;
  NumberInput anisotropy = 0;      ///< 0 to 1, along the tangent
  double anisotropy_rotation = 0;  ///< degrees, counter-clockwise from the tangent
  /// Cosine and sine of an additional angle, encoded as 0.5 + 0.5 * x in red and green.
  TextureId anisotropy_direction{};
  NumberInput diffuse_transmission = 0;  ///< fraction of the light in the diffuse base that leaves on the other side
  ColourInput diffuse_transmission_colour = 1;
};

using Bsdf = std::variant<Diffuse, Conductor, Dielectric, ThinDielectric, CoatedDiffuse, CoatedConductor,
                          DiffuseTransmission, Mix, Principled>;

/// A material of any kind, and what all kinds have: `Material clay = Diffuse{.reflectance = 0.6};`
struct Material {
  Bsdf bsdf;
  std::string name;
  NumberInput alpha = 1;     ///< opacity
  TextureId normal_map;      ///< normals in tangent space, encoded as 0.5 + 0.5 * n, z away from the surface
  double normal_scale = 1;   ///< factor on x and y of these
  TextureId displacement;    ///< scene units along the normal, used as a bump map
  bool double_sided = true;  ///< false: back faces are invisible to the camera

  Material() = default;
  template <AlternativeOf<Bsdf> Kind>
  Material(Kind&& kind, std::string its_name = {})  // NOLINT: each kind is a material
      : bsdf(std::forward<Kind>(kind)), name(std::move(its_name)) {}
};

}  // namespace ALHAZEN_NAMESPACE
