#pragma once

// Lights that are not shapes. Positions and directions are in world space; colours are not negative.

#include <string>
#include <utility>
#include <variant>

#include "alhazen/alternative.h"
#include "alhazen/geometry.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Orthonormal axes in world space.
struct Axes {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// Light from a point, equally in all directions.
struct PointLight {
  Colour intensity{1};  ///< W / sr
  Vec3 position{};
};

/// Light from a point within a cone.
struct SpotLight {
  Colour intensity{1};  ///< W / sr, on the axis
  Vec3 position{};
  Vec3 direction{0, 0, 1};    ///< in which the light travels, of any length but 0
  double cone_angle = 30;     ///< degrees from the axis to the edge, over 0 and at most 180
  double falloff_start = 25;  ///< degrees from the axis to where it begins to fade, 0 to `cone_angle`
};

/// Light from one direction, such as that of the sun.
struct DistantLight {
  Colour irradiance{1};     ///< W / m^2, at normal incidence
  Vec3 direction{0, 0, 1};  ///< in which the light travels, of any length but 0
  /// Degrees of its disk in the sky (the sun's are 0.53), from 0.01 to 180; 0: all from one direction.
  double angle = 0;
};

/// A point light whose intensity is multiplied by a square image over all directions (equal-area octahedral).
struct GoniometricLight {
  Colour intensity{1};  ///< W / sr, where the image is 1
  Vec3 position{};
  Axes axes{};  ///< of the image
};

/// Projects an image along the z axis, as a slide projector.
struct ProjectionLight {
  Colour intensity{1};  ///< W / sr, on the axis where the image is 1
  Vec3 position{};
  Axes axes{};
  double fov = 90;  ///< degrees over the shorter side of the image, over 0 and under 180
};

/// Light from everywhere.
struct ConstantInfiniteLight {
  Colour radiance{1};  ///< W / (m^2 sr)
};

/// Light from everywhere by an image: twice as wide as high (equirectangular) or square (equal-area octahedral), with
/// the map's z axis at the top.
struct EnvironmentLight {
  Colour scale{1};                              ///< factor on the image's radiance, W / (m^2 sr)
  Axes axes{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}};  ///< of the map: its top is towards +y, its centre towards -z
};

using LightKind = std::variant<PointLight, SpotLight, DistantLight, GoniometricLight, ProjectionLight,
                               ConstantInfiniteLight, EnvironmentLight>;

/// A light of any kind: `Light lamp = PointLight{.intensity = 40, .position = {0, 2, 0}};` The image of goniometric,
/// projection and environment lights is given when they are added.
struct Light {
  LightKind kind;
  std::string name;

  Light() = default;
  template <AlternativeOf<LightKind> Kind>
  Light(Kind&& of_kind, std::string its_name = {})  // NOLINT: each kind is a light
      : kind(std::forward<Kind>(of_kind)), name(std::move(its_name)) {}
};

}  // namespace ALHAZEN_NAMESPACE
