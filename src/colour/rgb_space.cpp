#include "colour/rgb_space.h"

#include <array>
#include <cmath>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// A matrix as three rows.
using Matrix3 = std::array<Vec3d, 3>;

constexpr Vec3d multiply(const Matrix3& m, const Vec3d& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

constexpr Matrix3 transpose(const Matrix3& m) {
  return {{{m[0].x, m[1].x, m[2].x}, {m[0].y, m[1].y, m[2].y}, {m[0].z, m[1].z, m[2].z}}};
}

constexpr Matrix3 multiply(const Matrix3& a, const Matrix3& b) {
  const Matrix3 columns = transpose(b);
  return transpose({multiply(a, columns[0]), multiply(a, columns[1]), multiply(a, columns[2])});
}

constexpr Matrix3 invert(const Matrix3& m) {
  const double determinant = dot(m[0], cross(m[1], m[2]));
  return transpose({cross(m[1], m[2]) / determinant, cross(m[2], m[0]) / determinant, cross(m[0], m[1]) / determinant});
}

/// Scales the columns of `m`.
constexpr Matrix3 scale_columns(const Matrix3& m, const Vec3d& factors) {
  return {m[0] * factors, m[1] * factors, m[2] * factors};
}

struct RgbSpace {
  const char* name;
  Chromaticities chromaticities;
};

constexpr Vec2d d65{0.3127, 0.3290};

// IEC 61966-2-1; ITU-R BT.2020; SMPTE RP 431-2 with the white of Display P3; SMPTE ST 2065-1.
constexpr RgbSpace srgb{"srgb", {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, d65}};
constexpr RgbSpace rec2020{"rec2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65}};
constexpr RgbSpace dci_p3{"dci-p3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65}};
constexpr RgbSpace aces{"aces2065-1", {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, {0.32168, 0.33767}}};

/// XYZ of a chromaticity, with x + y + z = 1.
constexpr Vec3d xyz_of(const Vec2d& xy) { return {xy.x, xy.y, 1 - xy.x - xy.y}; }

/// The XYZ of the white with Y = 1.
constexpr Vec3d white_of(const Chromaticities& space) { return xyz_of(space.white) / space.white.y; }

/// The primaries, scaled so that their sum is the white.
constexpr Matrix3 xyz_from_rgb(const Chromaticities& space) {
  const Matrix3 primaries = transpose({xyz_of(space.red), xyz_of(space.green), xyz_of(space.blue)});
  return scale_columns(primaries, multiply(invert(primaries), white_of(space)));
}

/// Chromatic adaptation of XYZ from one white to another, which scales cone responses by the Bradford method
/// (Lam 1985; the matrix is that of ICC.1, annex E).
constexpr Matrix3 adaptation(const Vec3d& from, const Vec3d& to) {
  constexpr Matrix3 cones{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const Vec3d gain = multiply(cones, to) / multiply(cones, from);
  return multiply(scale_columns(invert(cones), gain), cones);
}

constexpr Matrix3 srgb_from_xyz = invert(xyz_from_rgb(srgb.chromaticities));

constexpr Matrix3 srgb_from(const Chromaticities& space) {
  if (space.white == d65) return multiply(srgb_from_xyz, xyz_from_rgb(space));
  return multiply(srgb_from_xyz,
                  multiply(adaptation(white_of(space), white_of(srgb.chromaticities)), xyz_from_rgb(space)));
}

struct NamedMatrix {
  const char* name;
  Matrix3 srgb_from_space;
};

constexpr std::array<NamedMatrix, 3> other_spaces{{
    {rec2020.name, srgb_from(rec2020.chromaticities)},
    {dci_p3.name, srgb_from(dci_p3.chromaticities)},
    {aces.name, srgb_from(aces.chromaticities)},
}};

}  // namespace

SrgbFromPrimaries::SrgbFromPrimaries(const Chromaticities& chromaticities) {
  const Vec2d given[] = {chromaticities.red, chromaticities.green, chromaticities.blue, chromaticities.white};
  const Chromaticities& own = srgb.chromaticities;
  const Vec2d known[] = {own.red, own.green, own.blue, own.white};
  // Far below visible differences, and above rounding errors.
  constexpr double tolerance = 1e-5;
  is_identity_ = true;
  for (size_t i = 0; i < 4; ++i)
    is_identity_ = is_identity_ && std::abs(given[i].x - known[i].x) <= tolerance &&
                   std::abs(given[i].y - known[i].y) <= tolerance;
  rows_ = is_identity_ ? Matrix3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}} : srgb_from(chromaticities);
  for (const Vec3d& row : rows_)
    for (const double factor : {row.x, row.y, row.z})
      if (!(std::abs(factor) <= 1e6)) throw InputError("its chromaticities do not define a colour space");
}

Vec3d srgb_to_xyz(Vec3d rgb) { return multiply(xyz_from_rgb(srgb.chromaticities), rgb); }

std::array<Vec3d, 3> srgb_adaptation(const Vec2d& from, const Vec2d& to) {
  return multiply(srgb_from_xyz,
                  multiply(adaptation(xyz_of(from) / from.y, xyz_of(to) / to.y), xyz_from_rgb(srgb.chromaticities)));
}

Vec3d xyz_to_srgb(Vec3d xyz) { return multiply(srgb_from_xyz, xyz); }

bool is_rgb_space(const std::string& name) {
  for (const NamedMatrix& space : other_spaces)
    if (name == space.name) return true;
  return name == srgb.name;
}

Vec3d to_srgb(const std::string& space, Vec3d rgb) {
  if (space == srgb.name) return rgb;
  for (const NamedMatrix& other : other_spaces)
    if (space == other.name) return multiply(other.srgb_from_space, rgb);
  throw InputError("unknown colour space '" + space + "'; known are srgb, rec2020, dci-p3 and aces2065-1");
}

}  // namespace alhazen::impl
