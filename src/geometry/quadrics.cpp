#include "geometry/quadrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "geometry/tessellate.h"

namespace alhazen::impl {

bool is_similarity(const MovingTransform& transform) {
  double scale = 0;
  return transform.start.is_similarity(scale) && transform.end.is_similarity(scale);
}

bool is_cylinder_or_disk(const Shape& shape) {
  return shape.type == ShapeType::cylinder || shape.type == ShapeType::disk;
}

bool stays_exact(const Shape& shape, const MovingTransform& world_from_object) {
  constexpr double max_magnification = 1e4;  // of rounding, on the way to a shape of radius 1 and height 2, and back
  const Matrix4& there = world_from_object.start.matrix();
  const Matrix4 back = world_from_object.start.inverse().matrix();
  if (world_from_object.is_moving() || there[3] != std::array<double, 4>{0, 0, 0, 1}) return false;
  const bool is_disk = shape.type == ShapeType::disk;
  const std::array<double, 3> size{shape.radius, shape.radius,
                                   is_disk ? shape.radius : (shape.z_max - shape.z_min) / 2};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      double magnified = 0;
      for (size_t k = 0; k < 3; ++k) magnified += std::abs(back[i][k] / size[i] * there[k][j] * size[j]);
      if (!(magnified <= max_magnification)) return false;
    }
  return true;
}

Mesh mesh_of_quadric(const Shape& shape) {
  if (shape.type == ShapeType::sphere) return pbrt::tessellated_sphere(shape.radius, -shape.radius, shape.radius, 360);
  if (shape.type == ShapeType::disk)
    return pbrt::tessellated_disk(shape.radius, shape.inner_radius, shape.z_min, shape.phi_max);
  return pbrt::tessellated_cylinder(shape.radius, shape.z_min, shape.z_max, shape.phi_max);
}

namespace {

/// The meshes that take the place of quadrics in a scene.
class QuadricMeshes {
 public:
  explicit QuadricMeshes(Scene& scene) : scene_(scene) {}

  void replace(Shape& shape) {
    const Key key{shape.type, shape.radius, shape.inner_radius, shape.z_min, shape.z_max, shape.phi_max};
    const auto [entry, is_new] = meshes_.try_emplace(key, static_cast<uint32_t>(scene_.meshes.size()));
    if (is_new) scene_.meshes.push_back(mesh_of_quadric(shape));
    shape.type = ShapeType::mesh;
    shape.mesh = entry->second;
  }

 private:
  using Key = std::tuple<ShapeType, double, double, double, double, double>;
  Scene& scene_;
  std::map<Key, uint32_t> meshes_;
};

/// Returns whether `shape` is rendered as it is where `outer` places its group.
bool is_exact(const Shape& shape, const MovingTransform& outer, bool has_too_many_copies) {
  const MovingTransform& inner = shape.world_from_object;
  const MovingTransform whole{outer.start * inner.start, outer.end * inner.end};
  if (shape.type == ShapeType::sphere) return is_similarity(whole);
  return !shape.emission && !has_too_many_copies && stays_exact(shape, whole);
}

}  // namespace

namespace {

/// Calls visit(shape) for every quadric that is not exact where it is, or one of its copies is. It may replace them.
template <class AnyScene, class Visit>
void for_each_inexact_quadric(AnyScene& scene, const Visit& visit) {
  for (auto& shape : scene.groups.at(0).shapes)
    if (shape.type != ShapeType::mesh && !is_exact(shape, {}, false)) visit(shape);
  uint64_t copies = 0;
  for (const Instance& instance : scene.instances) {
    const std::vector<Shape>& shapes = scene.groups.at(instance.group).shapes;
    copies += static_cast<uint64_t>(std::count_if(shapes.begin(), shapes.end(), is_cylinder_or_disk));
  }
  for (const Instance& instance : scene.instances)
    for (auto& shape : scene.groups[instance.group].shapes)
      if (shape.type != ShapeType::mesh && !is_exact(shape, instance.world_from_group, copies > max_quadric_copies))
        visit(shape);
}

}  // namespace

bool has_inexact_quadrics(const Scene& scene) {
  bool has_any = false;
  for_each_inexact_quadric(scene, [&](const Shape&) { has_any = true; });
  return has_any;
}

void tessellate_inexact_quadrics(Scene& scene) {
  QuadricMeshes meshes(scene);
  for_each_inexact_quadric(scene, [&](Shape& shape) { meshes.replace(shape); });
}

}  // namespace alhazen::impl
