// What a file without cameras or lights is seen by.

#include <algorithm>
#include <cmath>

#include "core/lights/sphere_mapping.h"
#include "core/math/bounds.h"
#include "io/gltf/punctual.h"

namespace alhazen::gltf {

namespace {

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Calls visit(point) for every vertex in world space.
template <class Visit>
void for_each_vertex(const Scene& scene, const Visit& visit) {
  const auto visit_shape = [&](const Shape& shape, const Transform& world_from_object) {
    for (const Vec3d& p : scene.meshes[shape.mesh].positions) visit(world_from_object.point(p));
  };
  for (const Shape& shape : scene.groups[0].shapes) visit_shape(shape, shape.world_from_object.start);
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.groups[instance.group].shapes)
      visit_shape(shape, instance.world_from_group.start * shape.world_from_object.start);
}

}  // namespace

void fit_camera(Scene& scene) {
  Bounds3<double> box;
  for_each_vertex(scene, [&](const Vec3d& p) { box.extend(p); });
  if (box.is_empty()) box.extend(Vec3d{});
  const Vec3d center = box.center(), half = box.diagonal() * 0.5;
  const double radius = std::max(length(half), 1e-6);
  scene.camera.fov = 40;
  const double tangent = std::tan(20 * 3.14159265358979 / 180);
  // glTF has models face +z.
  const Vec3d backward = normalize(Vec3d{0.35, 0.25, 1});
  const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, backward)), up = cross(backward, right);
  // As near as leaves every corner of the box within the angle, and a little around it.
  double distance = radius * 1e-3;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
    const double sideways = std::max(std::abs(dot(p, right)), std::abs(dot(p, up)));
    distance = std::max(distance, 1.05 * sideways / tangent + dot(p, backward));
  }
  const Vec3d eye = center + backward * distance;
  scene.camera.world_from_camera.start = Transform(Matrix4{{{right.x, up.x, -backward.x, eye.x},
                                                            {right.y, up.y, -backward.y, eye.y},
                                                            {right.z, up.z, -backward.z, eye.z},
                                                            {0, 0, 0, 1}}});
  scene.camera.world_from_camera.end = scene.camera.world_from_camera.start;
}

void add_neutral_light(Scene& scene) {
  ImageTexels map;
  map.width = 128;
  map.height = 64;
  map.srgb = false;
  map.name = "the neutral light";
  const Vec3d window = normalize(Vec3d{-0.5, 0.8, 0.7});
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      // z of the map is up in the world.
      const Vec3d d =
          direction_of_square(SphereMapping::equirectangular, Vec2d{(x + 0.5) / map.width, (y + 0.5) / map.height});
      const Vec3d world{d.x, d.z, -d.y};
      const double sky = 0.25 + 0.35 * smoothstep(-1.0, 1.0, world.y);
      const double glow = 5 * smoothstep(0.93, 0.97, dot(world, window));
      for (int c = 0; c < 3; ++c) map.floats.push_back(static_cast<float>(sky + glow));
    }
  Light light;
  light.type = LightType::environment;
  light.radiance = {1, 1, 1};
  light.environment = static_cast<uint32_t>(scene.environments.size());
  // x, y, z of the map in the world: a rotation that takes z to y.
  light.axes = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  light.where = {scene.name};
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(light);
}

}  // namespace alhazen::gltf
