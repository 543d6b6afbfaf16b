#include "io/pbrt/colour_space.h"

#include <algorithm>
#include <cctype>

#include "scene/transform.h"

namespace alhazen::pbrt {

namespace {

struct Chromaticities {
  Vec2d red, green, blue, white;
};

constexpr Vec2d d65{0.3127, 0.3290};

// IEC 61966-2-1, SMPTE RP 431-2 with the white of displays, ITU-R BT.2020, SMPTE ST 2065-1.
constexpr Chromaticities srgb{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, d65};
constexpr Chromaticities dci_p3{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65};
constexpr Chromaticities rec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65};
constexpr Chromaticities aces{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};

/// XYZ of luminance 1.
Vec3d xyz_of(const Vec2d& xy) { return {xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y}; }

Transform from_columns(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return Transform(Matrix4{{{a.x, b.x, c.x, 0}, {a.y, b.y, c.y, 0}, {a.z, b.z, c.z, 0}, {0, 0, 0, 1}}});
}

Transform xyz_from_rgb(const Chromaticities& space) {
  const auto direction = [](const Vec2d& xy) { return Vec3d{xy.x, xy.y, 1 - xy.x - xy.y}; };
  const Transform primaries = from_columns(direction(space.red), direction(space.green), direction(space.blue));
  return primaries * Transform::scale(primaries.inverse().direction(xyz_of(space.white)));
}

/// Bradford adaptation of XYZ from one white to another.
Transform adaptation(const Vec2d& from, const Vec2d& to) {
  const Transform cone = from_columns({0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685}, {-0.1614, 0.0367, 1.0296});
  const Vec3d source = cone.direction(xyz_of(from)), target = cone.direction(xyz_of(to));
  return cone.inverse() * Transform::scale({target.x / source.x, target.y / source.y, target.z / source.z}) * cone;
}

Transform srgb_from(const Chromaticities& space) {
  return xyz_from_rgb(srgb).inverse() * adaptation(space.white, srgb.white) * xyz_from_rgb(space);
}

}  // namespace

std::optional<ColourSpace> colour_space_named(const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == "srgb") return ColourSpace::srgb;
  if (lower == "dci-p3") return ColourSpace::dci_p3;
  if (lower == "rec2020") return ColourSpace::rec2020;
  if (lower == "aces2065-1") return ColourSpace::aces2065_1;
  return {};
}

Vec3d to_srgb(ColourSpace space, const Vec3d& rgb) {
  static const Transform from_dci_p3 = srgb_from(dci_p3), from_rec2020 = srgb_from(rec2020),
                         from_aces = srgb_from(aces);
  switch (space) {
    case ColourSpace::srgb:
      break;
    case ColourSpace::dci_p3:
      return from_dci_p3.direction(rgb);
    case ColourSpace::rec2020:
      return from_rec2020.direction(rgb);
    case ColourSpace::aces2065_1:
      return from_aces.direction(rgb);
  }
  return rgb;
}

Vec3d srgb_from_xyz(const Vec3d& xyz) {
  static const Transform from_xyz = xyz_from_rgb(srgb).inverse();
  return from_xyz.direction(xyz);
}

}  // namespace alhazen::pbrt
