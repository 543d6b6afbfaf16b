#include "geometry/tessellate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alhazen::impl::pbrt {

namespace {

constexpr double pi = std::numbers::pi;

/// Number of segments in a full circle, and from pole to pole.
constexpr double segments_of_turn = 128;
constexpr double segments_of_meridian = 64;
constexpr uint32_t bilinear_segments = 8;

uint32_t segments(double part, double of_whole) {
  return static_cast<uint32_t>(std::max(2.0, std::ceil(part * of_whole - 1e-9)));
}

/// The point of the unit circle at column `column` of `columns`. A full circle ends exactly where it begins.
Vec2d on_circle(uint32_t column, uint32_t columns, double phi_max) {
  if (phi_max >= 360 && column == columns) return {1, 0};
  const double phi = phi_max * pi / 180 * column / columns;
  return {std::cos(phi), std::sin(phi)};
}

Vec2f uv_at(double u, double v) { return {static_cast<float>(u), static_cast<float>(v)}; }

/// Appends the triangles of a grid of (columns + 1) x (rows + 1) vertices that starts at `first`, counter-clockwise in
/// (u, v). Degenerate triangles are omitted.
void append_grid(uint32_t first, uint32_t columns, uint32_t rows, Mesh& mesh) {
  const auto add = [&mesh](uint32_t a, uint32_t b, uint32_t c) {
    const Vec3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (!(p == q) && !(q == r) && !(r == p)) mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t corner = first + row * (columns + 1) + column, above = corner + columns + 1;
      add(corner, corner + 1, above + 1);
      add(corner, above + 1, above);
    }
  }
}

bool is_flat_and_convex(const std::array<Vec3d, 4>& p) {
  // In order around the patch: p00, p10, p11, p01.
  const std::array<Vec3d, 4> ring{p[0], p[1], p[3], p[2]};
  const Vec3d normal = cross(ring[2] - ring[0], ring[3] - ring[1]);
  const double size = length(normal);
  if (!(size > 0)) return false;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d edge = ring[(i + 1) % 4] - ring[i], next = ring[(i + 2) % 4] - ring[(i + 1) % 4];
    if (!(dot(cross(edge, next), normal) > 0)) return false;
    // Lengths are compared with the square root of the area of the patch.
    if (std::abs(dot(edge, normal)) > 1e-6 * size * std::sqrt(size)) return false;
  }
  return true;
}

Vec3d patch_normal(const std::array<Vec3d, 4>& p, double u, double v) {
  return cross(lerp(p[1] - p[0], p[3] - p[2], v), lerp(p[2] - p[0], p[3] - p[1], u));
}

/// The normal of the patch at (u, v). If a side has zero length, it is that of the centre.
Vec3f unit_patch_normal(const std::array<Vec3d, 4>& p, double u, double v) {
  for (const Vec3d& normal : {patch_normal(p, u, v), patch_normal(p, 0.5, 0.5)}) {
    const double size = length(normal);
    if (size > 0 && std::isfinite(size)) return convert<float>(normal / size);
  }
  return {0, 0, 1};
}

template <class Value, class Weight>
Value bilinear(const std::array<Value, 4>& corners, Weight u, Weight v) {
  return corners[0] * ((1 - u) * (1 - v)) + corners[1] * (u * (1 - v)) + corners[2] * ((1 - u) * v) +
         corners[3] * (u * v);
}

Vec2f bilinear_uv(const std::array<Vec2f, 4>& corners, double u, double v) {
  const auto blend = [&](auto part) {
    const std::array<double, 4> parts{static_cast<double>(part(corners[0])), static_cast<double>(part(corners[1])),
                                      static_cast<double>(part(corners[2])), static_cast<double>(part(corners[3]))};
    return bilinear(parts, u, v);
  };
  return uv_at(blend([](const Vec2f& c) { return c.x; }), blend([](const Vec2f& c) { return c.y; }));
}

}  // namespace

Mesh tessellated_sphere(double radius, double z_min, double z_max, double phi_max) {
  const double low = std::acos(std::clamp(z_min / radius, -1.0, 1.0));
  const double high = std::acos(std::clamp(z_max / radius, -1.0, 1.0));
  const uint32_t columns = segments(phi_max / 360, segments_of_turn);
  const uint32_t rows = segments((low - high) / pi, segments_of_meridian);
  Mesh mesh;
  for (uint32_t row = 0; row <= rows; ++row) {
    const double v = static_cast<double>(row) / rows, theta = low + (high - low) * v;
    // sin(pi) is not exactly 0, but the pole is one point.
    const bool is_pole = theta <= 0 || theta >= pi;
    const double sin_theta = is_pole ? 0 : std::sin(theta), cos_theta = std::cos(theta);
    for (uint32_t column = 0; column <= columns; ++column) {
      const Vec2d circle = on_circle(column, columns, phi_max);
      const Vec3d normal{sin_theta * circle.x, sin_theta * circle.y, cos_theta};
      mesh.positions.push_back(normal * radius);
      mesh.normals.push_back(convert<float>(normal));
      mesh.uvs.push_back(uv_at(static_cast<double>(column) / columns, v));
    }
  }
  append_grid(0, columns, rows, mesh);
  return mesh;
}

Mesh tessellated_cylinder(double radius, double z_min, double z_max, double phi_max) {
  const uint32_t columns = segments(phi_max / 360, segments_of_turn);
  Mesh mesh;
  for (uint32_t row = 0; row <= 1; ++row) {
    for (uint32_t column = 0; column <= columns; ++column) {
      const Vec2d circle = on_circle(column, columns, phi_max);
      const Vec3d normal{circle.x, circle.y, 0};
      mesh.positions.push_back({normal.x * radius, normal.y * radius, row == 0 ? z_min : z_max});
      mesh.normals.push_back(convert<float>(normal));
      mesh.uvs.push_back(uv_at(static_cast<double>(column) / columns, row));
    }
  }
  append_grid(0, columns, 1, mesh);
  return mesh;
}

Mesh tessellated_disk(double radius, double inner_radius, double height, double phi_max) {
  const uint32_t columns = segments(phi_max / 360, segments_of_turn);
  const double step = phi_max * pi / 180 / columns;
  // A triangle of the fan has area sin(step) r^2 / 2, a sector of the circle step r^2 / 2.
  const double enlarged = std::sqrt(step / std::sin(step));
  Mesh mesh;
  for (uint32_t row = 0; row <= 1; ++row) {
    const double r = enlarged * (row == 0 ? radius : inner_radius);
    for (uint32_t column = 0; column <= columns; ++column) {
      const Vec2d circle = on_circle(column, columns, phi_max);
      mesh.positions.push_back({r * circle.x, r * circle.y, height});
      mesh.uvs.push_back(uv_at(static_cast<double>(column) / columns, row));
    }
  }
  append_grid(0, columns, 1, mesh);
  return mesh;
}

void append_bilinear_patch(const BilinearPatch& patch, bool own_normals, Mesh& mesh) {
  const auto& p = patch.corners;
  const uint32_t count = is_flat_and_convex(p) ? 1 : bilinear_segments;
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (uint32_t row = 0; row <= count; ++row) {
    for (uint32_t column = 0; column <= count; ++column) {
      const double u = static_cast<double>(column) / count, v = static_cast<double>(row) / count;
      mesh.positions.push_back(bilinear(p, u, v));
      mesh.uvs.push_back(bilinear_uv(patch.uvs, u, v));
      mesh.normals.push_back(own_normals ? bilinear(patch.normals, static_cast<float>(u), static_cast<float>(v))
                                         : unit_patch_normal(p, u, v));
    }
  }
  append_grid(first, count, count, mesh);
}

}  // namespace alhazen::impl::pbrt
