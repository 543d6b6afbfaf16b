// What ray queries find, compared with brute force over the description: triangles with their indices, shapes,
// instances, and motion, in both precisions of scenes and of arrays.

#include <gtest/gtest.h>

#include "queries/query_scene.h"
#include "support/described_hits.h"
#include "support/instanced_scenes.h"
#include "support/query_rays.h"

namespace alhazen::impl::test {

namespace {

/// Two meshes in one world. The first has triangles without area, long and narrow ones, and uvs; the second has shading
/// normals.
Scene scene_of_meshes() {
  Random random(3);
  Scene scene;
  scene.meshes.resize(2);
  Mesh& loose = scene.meshes[0];
  for (uint32_t i = 0; i < 300; ++i) {
    const Vec3d p = random.in_box(-2, 2), e1 = random.in_box(-1, 1);
    const Vec3d e2 = i % 3 == 0 ? e1 * 2 : i % 3 == 1 ? e1 * 0.5 + random.in_box(-1, 1) * 0.003 : random.in_box(-1, 1);
    for (const Vec3d& q : {p, p + e1, p + e2}) {
      loose.indices.push_back(static_cast<uint32_t>(loose.positions.size()));
      loose.positions.push_back(q);
      if (i % 3 == 0) loose.positions.back() = p;  // no area at all
    }
  }
  scene.meshes[1] = icosphere(3);
  for (const Vec3d& p : scene.meshes[1].positions) scene.meshes[1].normals.push_back(convert<float>(normalize(p)));
  for (const uint32_t mesh : {1u, 0u, 1u}) {
    Shape shape;
    shape.mesh = mesh;
    const Transform place = Transform::translate({0.5 * static_cast<double>(scene.groups[0].shapes.size()), 0, 0}) *
                            Transform::rotate(20, {1, 2, 3});
    shape.world_from_object = {place, place};
    scene.groups[0].shapes.push_back(shape);
  }
  return scene;
}

/// Spheres, cylinders and disks, whole and in part, static and moving, in the world and in instances.
Scene scene_of_quadrics() {
  Random random(5);
  Scene scene;
  scene.groups.resize(2);
  for (uint32_t i = 0; i < 60; ++i) {
    Shape shape;
    shape.type = i % 3 == 0 ? ShapeType::sphere : i % 3 == 1 ? ShapeType::cylinder : ShapeType::disk;
    shape.radius = random.between(0.2, 0.6);
    shape.z_min = shape.type == ShapeType::disk ? 0.1 : -0.4;
    shape.z_max = shape.type == ShapeType::disk ? 0.1 : 0.5;
    shape.inner_radius = shape.type == ShapeType::disk && i % 2 == 0 ? 0.1 : 0;
    shape.phi_max = i % 4 == 0 ? 250 : 360;
    const Transform place = Transform::translate(random.in_box(-2, 2)) *
                            Transform::rotate(360 * random.uniform<double>(), random.on_sphere());
    shape.world_from_object = {place, place};
    if (i % 6 == 0) shape.world_from_object.end = Transform::translate({0.3, 0.2, -0.5}) * place;
    scene.groups[i < 40 ? 0 : 1].shapes.push_back(shape);
  }
  for (int i = 0; i < 3; ++i) {
    Instance instance;
    instance.group = 1;
    const Transform place = Transform::translate(random.in_box(-2, 2)) * Transform::rotate(70, random.on_sphere());
    instance.world_from_group = {place, place};
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Meshes that move in the world, in instances, and in instances that move themselves; spheres and still meshes among
/// them, so that indices shift.
Scene scene_of_motion() {
  Scene scene = instanced_scene(7, 9, 4, true);
  Random random(8);
  for (size_t group = 0; group < 2; ++group)
    for (int i = 0; i < 3; ++i) {
      Shape shape;
      shape.mesh = 1;
      const Transform place = Transform::translate(random.in_box(-3, 3)) * Transform::scale({0.5, 0.5, 0.5});
      shape.world_from_object = {place, i == 1 ? place : Transform::translate({1, 0.5, -0.25}) * place};
      auto& shapes = scene.groups[group].shapes;
      shapes.insert(shapes.begin() + i, shape);
      Shape sphere;
      sphere.type = ShapeType::sphere;
      sphere.radius = 0.4;
      sphere.world_from_object = {place, place};
      if (group == 0) shapes.insert(shapes.begin(), sphere);
    }
  return scene;
}

/// So many triangles that instances refer to an object.
Scene scene_of_objects() {
  Scene scene = instanced_scene(9, 12, 4);
  scene.meshes[0] = icosphere(5);
  return scene;
}

/// Compares the hits of `count` random rays with brute force, `doubtful` of which may be too close to decide.
template <class Number>
void compare(const Scene& description, Precision precision, size_t count, size_t doubtful) {
  SCOPED_TRACE(std::string("arrays of ") + (sizeof(Number) == 4 ? "float" : "double") + ", scene in " +
               to_string(precision));
  Diagnostics diagnostics;
  const QueryScene scene(Scene(description), precision, 2, diagnostics);
  const bool is_double = precision == Precision::double_ && sizeof(Number) == 8;
  const double slack = is_double ? 1e-9 : 1e-3, tolerance = is_double ? 1e-9 : 3e-4;
  QueryRays<Number> rays = random_rays<Number>(count, 3, 11);
  QueryHits<Number> hits(count);
  scene.closest_hits(rays.arrays(), hits.arrays(), 2);
  std::vector<uint8_t> occluded(count);
  scene.occluded(rays.arrays(), occluded.data(), 2);
  size_t doubts = 0, found = 0;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d o = rays.origin(i), d = rays.direction(i);
    const double time = static_cast<double>(rays.times[i]), t_max = static_cast<double>(rays.t_max[i]);
    DescribedHit expected = described_hit(description, o, d, time, slack);
    if (expected.is_doubtful || std::abs(expected.t - t_max) < slack * t_max) {
      ++doubts;
      continue;
    }
    if (expected.t > t_max) expected = {};
    const bool is_hit = expected.primitive != no_index;
    found += is_hit;
    ASSERT_EQ(is_hit, occluded[i] != 0) << i;
    ASSERT_EQ(expected.primitive, hits.primitives[i]) << i;
    ASSERT_EQ(expected.shape, hits.shapes[i]) << i;
    ASSERT_EQ(expected.instance, hits.instances[i]) << i;
    if (!is_hit) {
      ASSERT_TRUE(hits.is_miss(i)) << i;
      continue;
    }
    const double reach = (expected.t * length(d) + length(o)) * tolerance;
    ASSERT_NEAR(expected.t, static_cast<double>(hits.t[i]), reach / length(d)) << i;
    ASSERT_LT(length(o + d * expected.t - hits.position(i)), 10 * reach) << i;
    ASSERT_NEAR(1, std::abs(dot(expected.normal, hits.normal(i))), 1e-5) << i;
    ASSERT_NEAR(1, length(hits.normal(i)), 1e-6) << i;
    ASSERT_NEAR(1, length(hits.shading_normal(i)), 1e-6) << i;
    // Barycentrics of small triangles at grazing angles are less accurate than points.
    const double steepness = std::abs(dot(expected.normal, d)) / length(d);
    ASSERT_NEAR(expected.b1, static_cast<double>(hits.barycentrics[2 * i]), 100 * tolerance / steepness) << i;
    ASSERT_NEAR(expected.b2, static_cast<double>(hits.barycentrics[2 * i + 1]), 100 * tolerance / steepness) << i;
    ASSERT_GT(hits.offsets[i], 0) << i;
  }
  EXPECT_LE(doubts, doubtful);
  EXPECT_GT(found, count / 16);
}

void compare_all(const Scene& description, size_t count, size_t doubtful) {
  compare<float>(description, Precision::single, count, doubtful);
  compare<double>(description, Precision::single, count, doubtful);
  compare<float>(description, Precision::double_, count, doubtful);
  compare<double>(description, Precision::double_, count, doubtful / 100);
}

}  // namespace

TEST(ClosestHits, MeshesAreAsDescribed) { compare_all(scene_of_meshes(), 800, 400); }
TEST(ClosestHits, SpheresCylindersAndDisksAreAsDescribed) { compare_all(scene_of_quadrics(), 2000, 1000); }
TEST(ClosestHits, CopiesOfInstancesAreAsDescribed) { compare_all(instanced_scene(1, 8, 4), 800, 400); }
TEST(ClosestHits, ObjectsAreAsDescribed) { compare<float>(scene_of_objects(), Precision::single, 100, 50); }
TEST(ClosestHits, MovingShapesAreAsDescribedAtTheTimesOfRays) { compare_all(scene_of_motion(), 500, 300); }

}  // namespace alhazen::impl::test
