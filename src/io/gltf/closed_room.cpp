// Handles a camera inside closed walls without any emission, such as below a sky dome: no light from outside enters.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "io/gltf/cameras_and_lights.h"

namespace alhazen::impl::gltf {

namespace {

struct Wall {
  bool is_hit = false;
  bool is_of_instance = false;
  size_t shape = 0;  ///< of group 0
};

bool lets_light_through(const Material& material) {
  return material.alpha != no_index || material.principled.transmission != no_index ||
         material.principled.diffuse_transmission != no_index;
}

/// The distance at which the ray hits the triangle, or 0 (Moeller, Trumbore 1997). `cull` ignores back faces.
double intersect_triangle(const Vec3d& origin, const Vec3d& direction, const Vec3d& p0, const Vec3d& p1,
                          const Vec3d& p2, bool cull) {
  const Vec3d e1 = p1 - p0, e2 = p2 - p0, normal = cross(direction, e2);
  const double determinant = dot(e1, normal);
  if (determinant == 0 || (cull && determinant < 0)) return 0;
  const Vec3d to_origin = origin - p0;
  const double u = dot(to_origin, normal) / determinant;
  const Vec3d q = cross(to_origin, e1);
  const double v = dot(direction, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return 0;
  return std::max(0.0, dot(e2, q) / determinant);
}

/// The last hit along the ray.
Wall outermost(const Scene& scene, const Vec3d& eye, const Vec3d& direction) {
  Wall wall;
  double farthest = 0;
  const auto visit = [&](const Shape& shape, const Transform& world, size_t index, bool is_of_instance) {
    const Material& material = scene.materials[shape.material];
    if (lets_light_through(material)) return;
    const Mesh& mesh = scene.meshes[shape.mesh];
    // In mesh space distances along the ray are the same.
    const Transform back = world.inverse();
    const Vec3d origin = back.point(eye), along = back.direction(direction);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const double t =
          intersect_triangle(origin, along, mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                             mesh.positions[mesh.indices[i + 2]], !material.double_sided);
      if (t > farthest) farthest = t, wall = {true, is_of_instance, index};
    }
  };
  for (size_t i = 0; i < scene.groups[0].shapes.size(); ++i)
    visit(scene.groups[0].shapes[i], scene.groups[0].shapes[i].world_from_object.start, i, false);
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.groups[instance.group].shapes)
      visit(shape, instance.world_from_group.start * shape.world_from_object.start, 0, true);
  return wall;
}

}  // namespace

bool light_closed_room(Scene& scene) {
  const Vec3d eye = scene.camera.world_from_camera.start.point({0, 0, 0});
  std::vector<bool> is_emissive(scene.groups[0].shapes.size());
  bool any = false;
  // Starts upwards: most scenes are open there, which one ray per triangle then shows.
  constexpr int steps = 5;
  for (int y = steps - 1; y >= 0; --y)
    for (int x = 0; x < 2 * steps; ++x) {
      // The directions avoid the edges of axis-aligned boxes.
      const double height = -0.93 + 1.9 * (y + 0.5) / steps, turn = 0.613 + (x + 0.37 * y) * std::numbers::pi / steps;
      const double ring = std::sqrt(1 - height * height);
      const Wall wall = outermost(scene, eye, {ring * std::cos(turn), height, ring * std::sin(turn)});
      if (!wall.is_hit) return false;
      if (!wall.is_of_instance) is_emissive[wall.shape] = any = true;
    }
  if (!any) return false;
  for (size_t i = 0; i < is_emissive.size(); ++i) {
    Shape& shape = scene.groups[0].shapes[i];
    if (!is_emissive[i] || shape.emission) continue;
    const Material& material = scene.materials[shape.material];
    const uint32_t colour =
        material.kind == MaterialKind::principled ? material.principled.base_colour : material.reflectance;
    shape.emission = Emission{{1, 1, 1}, material.double_sided, colour};
  }
  return true;
}

}  // namespace alhazen::impl::gltf
