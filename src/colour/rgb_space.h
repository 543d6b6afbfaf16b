#pragma once

// RGB colour spaces and their conversion to linear sRGB.

#include <array>
#include <string>

#include "core/math/vec.h"

namespace alhazen::impl {

/// Converts CIE XYZ to linear sRGB; Y = 1 with the chromaticity of D65 is (1, 1, 1). Out-of-gamut colours are negative.
Vec3d xyz_to_srgb(Vec3d xyz);
Vec3d srgb_to_xyz(Vec3d rgb);

/// The rows of a matrix that adapts linear sRGB from one white to another by the Bradford method. The whites are CIE
/// 1931 x and y; what has the first becomes what has the second, and as bright.
std::array<Vec3d, 3> srgb_adaptation(const Vec2d& from, const Vec2d& to);

/// CIE 1931 x and y of the primaries and of their white, the sum of equal parts.
struct Chromaticities {
  Vec2d red, green, blue, white;
};

/// Converts linear RGB with given primaries to linear sRGB. White stays white, as below.
class SrgbFromPrimaries {
 public:
  /// Throws InputError if the chromaticities are invalid: not finite, on one line, or with a white of zero luminance.
  explicit SrgbFromPrimaries(const Chromaticities& chromaticities);
  /// Whether nothing changes: the primaries are those of sRGB up to float precision.
  bool is_identity() const { return is_identity_; }
  Vec3d operator()(const Vec3d& rgb) const { return {dot(rows_[0], rgb), dot(rows_[1], rgb), dot(rows_[2], rgb)}; }

 private:
  std::array<Vec3d, 3> rows_{};
  bool is_identity_ = false;
};

/// True for the names that to_srgb accepts: srgb, rec2020, dci-p3 (with the white D65), aces2065-1.
bool is_rgb_space(const std::string& name);

/// Converts linear `rgb` of the named space to linear sRGB. White stays white: a white other than D65 (aces2065-1) is
/// adapted by the Bradford method. Throws InputError if the name is unknown.
Vec3d to_srgb(const std::string& space, Vec3d rgb);

}  // namespace alhazen::impl
