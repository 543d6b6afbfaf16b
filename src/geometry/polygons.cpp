#include "geometry/polygons.h"

#include <cmath>

#include "geometry/ear_clipping.h"

namespace alhazen::impl {

namespace {

/// A polygon, stored as a fan in the indices of a mesh.
class Fan {
 public:
  Fan(uint32_t* indices, uint64_t corners) : indices_(indices), corners_(corners) {}

  uint64_t corners() const { return corners_; }
  uint32_t corner(uint64_t i) const { return i < 2 ? indices_[i] : indices_[3 * (i - 2) + 2]; }
  uint32_t* triangle(uint64_t i) { return indices_ + 3 * i; }

 private:
  uint32_t* indices_;
  uint64_t corners_;
};

/// Twice the area of the triangle of the first corner and corners i and i + 1, along the normal.
Vec3d fan_area(const Mesh& mesh, const Fan& fan, uint64_t i) {
  const Vec3d& first = mesh.positions[fan.corner(0)];
  return cross(mesh.positions[fan.corner(i)] - first, mesh.positions[fan.corner(i + 1)] - first);
}

/// Twice the area of the polygon along its normal; if it is not planar, of its largest projection.
Vec3d polygon_area(const Mesh& mesh, const Fan& fan) {
  Vec3d sum{};
  for (uint64_t i = 1; i + 1 < fan.corners(); ++i) sum = sum + fan_area(mesh, fan, i);
  return sum;
}

/// Returns whether no triangle of the fan is flipped. Slivers of a millionth of the area, which rounding may flip, do
/// not count.
bool covers_the_polygon(const Mesh& mesh, const Fan& fan, const Vec3d& area) {
  const double size = max_component(abs(area));
  if (!(size > 0)) return true;
  const Vec3d direction = area / size;
  const double min_area = -1e-6 * dot(area, direction);
  for (uint64_t i = 1; i + 1 < fan.corners(); ++i)
    if (dot(fan_area(mesh, fan, i), direction) < min_area) return false;
  return true;
}

/// Projects the corners along the axis closest to the normal, counter-clockwise, and scales them by a power of two so
/// that areas neither overflow nor underflow.
void project(const Mesh& mesh, const Fan& fan, const Vec3d& normal, std::vector<Vec2d>& corners) {
  const Vec3d size = abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool turned = (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) < 0;
  corners.clear();
  double largest = 0;
  for (uint64_t i = 0; i < fan.corners(); ++i) {
    const Vec3d& p = mesh.positions[fan.corner(i)];
    const Vec2d flat = axis == 0 ? Vec2d{p.y, p.z} : axis == 1 ? Vec2d{p.z, p.x} : Vec2d{p.x, p.y};
    corners.push_back(turned ? Vec2d{flat.y, flat.x} : flat);
    largest = std::fmax(largest, std::fmax(std::abs(flat.x), std::abs(flat.y)));
  }
  const double scale = std::ldexp(1.0, -std::ilogb(largest));
  for (Vec2d& corner : corners) corner = {corner.x * scale, corner.y * scale};
}

}  // namespace

void Polygons::add(uint64_t triangles, uint64_t corners) {
  const uint64_t first = triangles - (corners - 2);
  if (!runs_.empty()) {
    Run& last = runs_.back();
    if (last.corners == corners && last.first + last.count * (corners - 2) == first) {
      ++last.count;
      return;
    }
  }
  runs_.push_back({first, corners, 1});
}

void Polygons::triangulate(Mesh& mesh) const {
  EarClipper clipper;
  std::vector<Vec2d> flat;
  std::vector<uint32_t> corners;
  for (const Run& run : runs_)
    for (uint64_t k = 0; k < run.count; ++k) {
      Fan fan(mesh.indices.data() + 3 * (run.first + k * (run.corners - 2)), run.corners);
      const Vec3d area = polygon_area(mesh, fan);
      if (covers_the_polygon(mesh, fan, area)) continue;
      project(mesh, fan, area, flat);
      corners.clear();
      for (uint64_t i = 0; i < run.corners; ++i) corners.push_back(fan.corner(i));
      uint64_t triangle = 0;
      for (const auto& [a, b, c] : clipper.triangulate(flat)) {
        uint32_t* const out = fan.triangle(triangle++);
        out[0] = corners[a];
        out[1] = corners[b];
        out[2] = corners[c];
      }
    }
}

}  // namespace alhazen::impl
