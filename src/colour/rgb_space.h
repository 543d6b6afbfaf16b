#pragma once

// Colour spaces of three primaries, and their way to linear sRGB.

#include <array>
#include <string>

#include "core/math/vec.h"

namespace alhazen {

/// Linear sRGB of CIE XYZ, whose Y = 1 with the chromaticity of D65 is (1, 1, 1). May be negative: out of gamut.
Vec3d xyz_to_srgb(Vec3d xyz);

/// CIE 1931 x and y of the primaries and of the white that equal parts of them make.
struct Chromaticities {
  Vec2d red, green, blue, white;
};

/// Linear sRGB of linear red, green and blue of primaries. White stays white, as below.
class SrgbFromPrimaries {
 public:
  /// Throws InputError where these make no colours: not finite, on one line, or of a white without luminance.
  explicit SrgbFromPrimaries(const Chromaticities& chromaticities);
  /// Whether nothing changes: the primaries are those of sRGB, but for what a float may differ.
  bool is_identity() const { return is_identity_; }
  Vec3d operator()(const Vec3d& rgb) const { return {dot(rows_[0], rgb), dot(rows_[1], rgb), dot(rows_[2], rgb)}; }

 private:
  std::array<Vec3d, 3> rows_{};
  bool is_identity_ = false;
};

/// True for the names that to_srgb knows: srgb, rec2020, dci-p3 (with the white D65), aces2065-1.
bool is_rgb_space(const std::string& name);

/// Linear sRGB of linear `rgb` of the space of that name. White stays white: what has another white than D65
/// (aces2065-1) is adapted to it by the method of Bradford. Throws InputError where the name is not known.
Vec3d to_srgb(const std::string& space, Vec3d rgb);

}  // namespace alhazen
