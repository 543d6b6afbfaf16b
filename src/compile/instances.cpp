#include "compile/instances.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace alhazen::impl {

namespace {

/// Returns whether an object contains this shape of its group: lights, spheres, cylinders and disks are copied to
/// the world instead.
bool is_in_object(const Shape& shape) { return shape.type == ShapeType::mesh && !emits(shape); }

struct DescribedInstance {
  Instance instance;
  uint32_t index = no_index;  ///< in the description
};

/// If the instance moves too, the positions at start and end are exact, and points move linearly in between.
void move_by_instances(Shape shape, uint32_t index, const std::vector<DescribedInstance>& of_object, Scene& scene,
                       DescribedIndices& described) {
  const MovingTransform inner = std::exchange(shape.world_from_object, {});
  for (auto [instance, instance_index] : of_object) {
    const MovingTransform& outer = instance.world_from_group;
    if (instance.group == no_index) {
      instance.where = shape.where;
      instance.name = shape.name;
    }
    instance.world_from_group = {outer.start * inner.start, outer.end * inner.end};
    instance.group = static_cast<uint32_t>(scene.groups.size());
    scene.instances.push_back(std::move(instance));
    described.instances.push_back(instance_index);
  }
  scene.groups.push_back({{}, {std::move(shape)}});
  described.shapes.push_back({index});
}

/// Matrices are interpolated linearly.
Transform transform_at(const Scene& scene, const Instance& instance, double time) {
  const MovingTransform& transform = instance.world_from_group;
  const double s = fraction_of_motion(scene, transform, time);
  if (s == 0) return transform.start;
  Matrix4 matrix;
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      matrix[i][j] = transform.start.matrix()[i][j] * (1 - s) + transform.end.matrix()[i][j] * s;
  try {
    return Transform(matrix);
  } catch (const std::domain_error&) {
    throw InputError(instance.where, "the transform makes the object flat while it moves");
  }
}

}  // namespace

bool emits(const Shape& shape) { return shape.emission && max_component(shape.emission->radiance) > 0; }

const Mesh& mesh_of(const Scene& scene, const Shape& shape) {
  if (shape.mesh >= scene.meshes.size()) throw InputError(shape.where, "the shape names no mesh");
  return scene.meshes[shape.mesh];
}

double fraction_of_motion(const Scene& scene, const MovingTransform& transform, double time) {
  const double span = scene.transform_end_time - scene.transform_start_time;
  if (!transform.is_moving() || !(span > 0)) return 0;
  return clamp((time - scene.transform_start_time) / span, 0.0, 1.0);
}

DescribedIndices group_moving_meshes(Scene& scene) {
  const size_t group_count = scene.groups.size();
  DescribedIndices described;
  described.shapes.resize(group_count);
  described.instances.resize(scene.instances.size());
  std::iota(described.instances.begin(), described.instances.end(), 0u);
  std::vector<std::vector<DescribedInstance>> instances(group_count);
  instances.at(0).emplace_back();  // the world itself
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    if (scene.instances[i].group < group_count) instances[scene.instances[i].group].push_back({scene.instances[i], i});
  for (size_t g = 0; g < group_count; ++g) {
    std::vector<Shape> still;
    uint32_t index = 0;
    for (Shape& shape : std::exchange(scene.groups[g].shapes, {})) {
      if (shape.world_from_object.is_moving() && is_in_object(shape)) {
        move_by_instances(std::move(shape), index, instances[g], scene, described);
      } else {
        still.push_back(std::move(shape));
        described.shapes[g].push_back(index);
      }
      ++index;
    }
    scene.groups[g].shapes = std::move(still);
  }
  return described;
}

std::vector<uint64_t> triangle_counts(const Scene& scene) {
  std::vector<uint64_t> counts;
  for (const Mesh& mesh : scene.meshes) counts.push_back(mesh.triangle_count());
  return counts;
}

std::vector<bool> find_objects(const Scene& scene, const std::vector<uint64_t>& triangle_counts,
                               uint64_t max_copied_triangles) {
  std::vector<uint64_t> uses(scene.groups.size()), triangles(scene.groups.size());
  std::vector<bool> moves(scene.groups.size());
  for (const Instance& instance : scene.instances) {
    if (instance.group >= scene.groups.size()) throw InputError(instance.where, "the instance names no object");
    ++uses[instance.group];
    if (instance.world_from_group.is_moving()) moves[instance.group] = true;
  }
  uint64_t copied = 0;
  for (size_t g = 0; g < scene.groups.size(); ++g) {
    for (const Shape& shape : scene.groups[g].shapes)
      if (is_in_object(shape)) {
        mesh_of(scene, shape);
        triangles[g] += triangle_counts[shape.mesh];
      }
    if (uses[g] > 1) copied += uses[g] * triangles[g];
  }
  std::vector<bool> is_object(scene.groups.size());
  for (size_t g = 0; g < is_object.size(); ++g)
    is_object[g] = triangles[g] > 0 && (moves[g] || (copied > max_copied_triangles && uses[g] > 1));
  return is_object;
}

std::vector<ShapePlacement> world_placements(const Scene& scene, const std::vector<bool>& is_object,
                                             const DescribedIndices& described) {
  std::vector<ShapePlacement> all;
  for (size_t i = 0; i < scene.groups.at(0).shapes.size(); ++i) {
    const Shape& shape = scene.groups[0].shapes[i];
    all.push_back({&shape, shape.world_from_object, shape.reverse_orientation, {described.shapes[0][i], no_index}});
  }
  for (size_t n = 0; n < scene.instances.size(); ++n) {
    const Instance& instance = scene.instances[n];
    const MovingTransform& outer = instance.world_from_group;
    const std::vector<Shape>& shapes = scene.groups[instance.group].shapes;
    for (size_t i = 0; i < shapes.size(); ++i)
      if (!is_object[instance.group] || !is_in_object(shapes[i]))
        all.push_back({&shapes[i],
                       {outer.start * shapes[i].world_from_object.start, outer.end * shapes[i].world_from_object.end},
                       shapes[i].reverse_orientation != instance.reverse_orientation,
                       {described.shapes[instance.group][i], described.instances[n]},
                       &instance});
  }
  return all;
}

std::vector<std::vector<ShapePlacement>> object_placements(const Scene& scene, const std::vector<bool>& is_object,
                                                           const DescribedIndices& described) {
  std::vector<std::vector<ShapePlacement>> objects(scene.groups.size());
  for (size_t g = 0; g < objects.size(); ++g) {
    if (!is_object[g]) continue;
    const std::vector<Shape>& shapes = scene.groups[g].shapes;
    for (size_t i = 0; i < shapes.size(); ++i)
      if (is_in_object(shapes[i]))
        objects[g].push_back({&shapes[i],
                              shapes[i].world_from_object,
                              shapes[i].reverse_orientation,
                              {described.shapes[g][i], no_index}});
  }
  return objects;
}

template <class Real>
void add_instance(const Scene& scene, const Instance& instance, uint32_t object, SceneArrays<Real>& out) {
  const Transform opening = transform_at(scene, instance, scene.camera.shutter_open);
  const Transform closing = transform_at(scene, instance, scene.camera.shutter_close);
  const Matrix4 &there = opening.matrix(), back = opening.inverse().matrix(), in_the_end = closing.matrix();
  InstanceRecord<Real> record{};
  InstanceMotion<Real> motion{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) {
      record.world_from_object[i][j] = static_cast<Real>(there[i][j]);
      record.object_from_world[i][j] = static_cast<Real>(back[i][j]);
      motion.change[i][j] = static_cast<Real>(in_the_end[i][j] - there[i][j]);
      if (!std::isfinite(record.world_from_object[i][j]) || !std::isfinite(record.object_from_world[i][j]) ||
          !std::isfinite(motion.change[i][j]))
        throw InputError(instance.where, "the transform of the object is not finite, or makes it flat");
    }
  record.object = object;
  record.flip_normal = instance.reverse_orientation ? 1 : 0;
  record.motion = no_motion;
  if (!(opening == closing)) {
    record.motion = static_cast<uint32_t>(out.instance_motions.size());
    out.instance_motions.push_back(motion);
  }
  out.instances.push_back(record);
}

template void add_instance(const Scene&, const Instance&, uint32_t, SceneArrays<float>&);
template void add_instance(const Scene&, const Instance&, uint32_t, SceneArrays<double>&);

}  // namespace alhazen::impl
