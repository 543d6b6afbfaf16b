#include "compile/render_space.h"

#include <algorithm>
#include <cmath>

#include "core/math/bounds.h"

namespace alhazen::impl {

namespace {

/// The world is moved if the camera is this many times farther from the origin than from what it sees.
constexpr double min_distance_ratio = 16;

using Box = Bounds3<double>;

Box transformed(const Box& box, const Transform& transform) {
  Box all;
  for (int corner = 0; corner < 8 && !box.is_empty(); ++corner)
    all.extend(transform.point({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                corner & 4 ? box.high.z : box.low.z}));
  return all;
}

Box box_of(const Mesh& mesh) {
  Box box;
  for (const Vec3d& p : mesh.positions) box.extend(p);
  return box;
}

/// The bounding boxes of everything that is placed in the world, in object or group space, and transformed.
std::vector<Box> world_boxes(const Scene& scene) {
  std::vector<Box> meshes;
  for (const Mesh& mesh : scene.meshes) meshes.push_back(box_of(mesh));
  const auto box_of_shape = [&](const Shape& shape) {
    const bool is_mesh = shape.type == ShapeType::mesh;
    if (is_mesh && shape.mesh >= meshes.size()) return Box{};
    const Box box = is_mesh ? meshes[shape.mesh] : Box{-shape.reach(), shape.reach()};
    return transformed(box, shape.world_from_object.start);
  };
  std::vector<Box> boxes;
  for (const Shape& shape : scene.groups.at(0).shapes) boxes.push_back(box_of_shape(shape));
  std::vector<Box> groups(scene.groups.size());
  for (size_t g = 1; g < groups.size(); ++g)
    for (const Shape& shape : scene.groups[g].shapes) groups[g].extend(box_of_shape(shape));
  for (const Instance& instance : scene.instances)
    if (instance.group < groups.size())
      boxes.push_back(transformed(groups[instance.group], instance.world_from_group.start));
  return boxes;
}

double distance_to(const Box& box, const Vec3d& p) {
  const auto outside = [](double low, double high, double x) { return std::max({low - x, x - high, 0.0}); };
  return length(Vec3d{outside(box.low.x, box.high.x, p.x), outside(box.low.y, box.high.y, p.y),
                      outside(box.low.z, box.high.z, p.z)});
}

/// The point of the world that becomes the origin.
Vec3d origin_of(const Scene& scene, const Camera& seen_by) {
  const Vec3d camera = seen_by.world_from_camera.start.point({});
  double nearest = infinity<double>;
  Box all;
  for (const Box& box : world_boxes(scene)) {
    if (box.is_empty()) continue;
    nearest = std::min(nearest, distance_to(box, camera) + length(box.high - box.low));
    all.extend(box);
  }
  if (all.is_empty()) return {};
  if (length(camera) > min_distance_ratio * nearest) return camera;
  const Vec3d middle = (all.low + all.high) * 0.5;
  return length(middle) > min_distance_ratio * length(all.high - all.low) ? middle : Vec3d{};
}

}  // namespace

bool is_in_render_space(const Scene& scene, const Camera& camera) {
  const Vec3d origin = origin_of(scene, camera);
  return is_zero(origin) || !is_finite(origin);
}

Vec3d move_to_render_space(Scene& scene) {
  const Vec3d origin = origin_of(scene, scene.camera);
  if (is_zero(origin) || !is_finite(origin)) return {};
  const Transform there = Transform::translate(-origin), back = Transform::translate(origin);
  const auto move = [&](MovingTransform& transform) { transform = {there * transform.start, there * transform.end}; };
  move(scene.camera.world_from_camera);
  for (Shape& shape : scene.groups.at(0).shapes) move(shape.world_from_object);
  for (Instance& instance : scene.instances) move(instance.world_from_group);
  for (Light& light : scene.lights) light.position -= origin;
  for (Texture& texture : scene.textures) texture.texture_from_world = texture.texture_from_world * back;
  return origin;
}

}  // namespace alhazen::impl
