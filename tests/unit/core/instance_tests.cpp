// Instances are hit where copies of their object would be, with every tree, and rays that start on them do not hit them
// again.

#include <gtest/gtest.h>

#include "core/bvh/brute_force/intersector.h"
#include "core/integrators/stages.h"
#include "support/effort.h"
#include "support/engines.h"
#include "support/instanced_scenes.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

constexpr double reach = 10;

template <class Real>
Ray<Real> random_ray(Random& random) {
  const Vec3d origin = random.in_box(-2 * reach, 2 * reach);
  return {convert<Real>(origin), normalize(convert<Real>(random.in_box(-reach, reach) - origin)), Real(0)};
}

template <class Tree>
class InstancesInTree : public ::testing::Test {};
TYPED_TEST_SUITE(InstancesInTree, Engines);

TYPED_TEST(InstancesInTree, AreHitAsByTheLinearScan) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = flat_instanced_scene<Real>(instanced_scene(1, 40, reach), false);
  ASSERT_EQ(scene.view.instances_count, 40u);
  const typename TypeParam::Intersector tree(scene.view);
  const BruteForceIntersector<Real> linear(scene.view);
  Random random(2);
  size_t hit_instances = 0;
  for (size_t i = 0; i < effort(10'000); ++i) {
    const Ray<Real> ray = random_ray<Real>(random);
    const Real limit = i % 4 == 0 ? static_cast<Real>(random.magnitude_between(1, 30)) : infinity<Real>;
    Hit<Real> hit, expected;
    const bool found = linear.closest_hit(ray, limit, expected);
    ASSERT_EQ(tree.closest_hit(ray, limit, hit), found);
    ASSERT_EQ(tree.occluded(ray, limit), found);
    if (!found) continue;
    ASSERT_EQ(hit.t, expected.t);
    ASSERT_EQ(hit.b1, expected.b1);
    ASSERT_EQ(hit.b2, expected.b2);
    ASSERT_TRUE(hit.primitive == expected.primitive);
    ASSERT_EQ(hit.instance, expected.instance);
    hit_instances += hit.instance != no_instance;
  }
  EXPECT_GT(hit_instances, effort(10'000) / 10);
}

TYPED_TEST(InstancesInTree, AreHitWhereTheyMove) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = flat_instanced_scene<Real>(instanced_scene(11, 15, reach, true), false);
  ASSERT_EQ(scene.view.instance_motions_count, 5u);
  const typename TypeParam::Intersector tree(scene.view);
  const BruteForceIntersector<Real> linear(scene.view);
  Random random(12);
  size_t hit_moving = 0;
  for (size_t i = 0; i < effort(5'000); ++i) {
    Ray<Real> ray = random_ray<Real>(random);
    ray.time = random.uniform<Real>();
    Hit<Real> hit, expected;
    const bool found = linear.closest_hit(ray, infinity<Real>, expected);
    ASSERT_EQ(tree.closest_hit(ray, infinity<Real>, hit), found);
    ASSERT_EQ(tree.occluded(ray, infinity<Real>), found);
    if (!found) continue;
    ASSERT_EQ(hit.t, expected.t);
    ASSERT_TRUE(hit.primitive == expected.primitive);
    ASSERT_EQ(hit.instance, expected.instance);
    hit_moving += hit.instance != no_instance && scene.view.instances[hit.instance].motion != no_motion;
  }
  EXPECT_GT(hit_moving, effort(5'000) / 100);
}

/// Of two coincident instances, the lower one is hit, whichever is visited first.
TYPED_TEST(InstancesInTree, OfTwoInOnePlaceTheLowerCounts) {
  using Real = typename TypeParam::Real;
  Scene twice = instanced_scene(3, 20, reach);
  const std::vector<Instance> once = twice.instances;
  twice.instances.insert(twice.instances.end(), once.begin(), once.end());
  const CompiledScene<Real> scene = flat_instanced_scene<Real>(twice, false);
  const typename TypeParam::Intersector tree(scene.view);
  Random random(4);
  size_t hit_count = 0;
  for (size_t i = 0; i < effort(5'000); ++i) {
    const Ray<Real> ray = random_ray<Real>(random);
    Hit<Real> hit;
    if (!tree.closest_hit(ray, infinity<Real>, hit) || hit.instance == no_instance) continue;
    ++hit_count;
    ASSERT_LT(hit.instance, once.size());
    // A limit of exactly that distance excludes the hit.
    Hit<Real> before;
    if (tree.closest_hit(ray, hit.t, before)) {
      ASSERT_LT(before.t, hit.t);
    }
  }
  EXPECT_GT(hit_count, effort(5'000) / 20);
}

template <class Real>
class Instances : public ::testing::Test {};
TYPED_TEST_SUITE(Instances, Reals);

/// A mesh that moves within an object becomes an instance of its own wherever the object is placed.
TYPED_TEST(Instances, OfMeshesThatMoveWithinAnObject) {
  using Real = TypeParam;
  Scene described = instanced_scene(21, 6, reach, true);
  Random random(22);
  Shape& moving = described.groups[1].shapes[1];
  moving.world_from_object.end = Transform::translate({0.5, 1, -0.5}) * moving.world_from_object.start;
  // The same, constructed explicitly: the static mesh in the object, the moving one in a group of its own.
  Scene expected = described;
  const Shape taken = expected.groups[1].shapes[1];
  expected.groups[1].shapes.pop_back();
  ShapeGroup alone;
  alone.shapes.push_back(taken);
  alone.shapes[0].world_from_object = {};
  expected.groups.push_back(alone);
  for (const Instance& instance : described.instances) {
    Instance copy = instance;
    copy.group = 2;
    copy.world_from_group = {instance.world_from_group.start * taken.world_from_object.start,
                             instance.world_from_group.end * taken.world_from_object.end};
    expected.instances.push_back(copy);
  }
  const CompiledScene<Real> flat = flat_instanced_scene<Real>(described, false);
  const CompiledScene<Real> by_hand = flat_instanced_scene<Real>(expected, false);
  ASSERT_EQ(flat.view.instances_count, 12u);
  EXPECT_EQ(flat.view.instance_motions_count, 2u + 6u);
  size_t hit_count = 0;
  for (size_t i = 0; i < effort(5'000); ++i) {
    Ray<Real> ray = random_ray<Real>(random);
    ray.time = random.uniform<Real>();
    Hit<Real> a, b;
    const bool found = BruteForceIntersector<Real>(by_hand.view).closest_hit(ray, infinity<Real>, b);
    ASSERT_EQ(Bvh2Intersector<Real>(flat.view).closest_hit(ray, infinity<Real>, a), found);
    if (!found) continue;
    ASSERT_EQ(a.t, b.t);
    ASSERT_EQ(a.instance, b.instance);
    hit_count += a.instance != no_instance && a.instance >= 6;
  }
  EXPECT_GT(hit_count, effort(5'000) / 100);
}

TYPED_TEST(Instances, LookLikeCopies) {
  using Real = TypeParam;
  const Scene described = instanced_scene(5, 40, reach);
  const CompiledScene<Real> instances = flat_instanced_scene<Real>(described, false);
  const CompiledScene<Real> copies = flat_instanced_scene<Real>(described, true);
  EXPECT_EQ(copies.view.instances_count, 0u);
  EXPECT_LT(instances.view.triangles_count * 20, copies.view.triangles_count);
  const double tolerance = 2e4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  Random random(6);
  size_t hit_count = 0, apart = 0;
  for (size_t i = 0; i < effort(20'000); ++i) {
    const Ray<Real> ray = random_ray<Real>(random);
    Hit<Real> a, b;
    const bool found = Bvh2Intersector<Real>(instances.view).closest_hit(ray, infinity<Real>, a);
    if (Bvh2Intersector<Real>(copies.view).closest_hit(ray, infinity<Real>, b) != found ||
        (found && std::abs(static_cast<double>(a.t - b.t)) > tolerance)) {
      ++apart;  // past an edge because of rounding
      continue;
    }
    if (!found) continue;
    ++hit_count;
    const SurfaceInteraction<Real> of_instance = surface_interaction(instances.view, ray, a);
    const SurfaceInteraction<Real> of_copy = surface_interaction(copies.view, ray, b);
    const auto distance = [](const Vec3<Real>& x, const Vec3<Real>& y) { return static_cast<double>(length(x - y)); };
    ASSERT_LT(distance(of_instance.position, of_copy.position), tolerance);
    // Across an edge normals may be those of the other triangle, but never of the other side.
    ASSERT_GT(dot(of_instance.normal, of_copy.normal), Real(0.5));
    ASSERT_LT(distance(of_instance.shading_normal, of_copy.shading_normal), 0.7);
    if (distance(of_instance.normal, of_copy.normal) > 1e-2) ++apart;
  }
  EXPECT_GT(hit_count, effort(20'000) / 10);
  EXPECT_LT(apart, hit_count / 1000 + 3);
}

/// The error bound of a point on an instance includes the errors of transforming it out of the object's space and back.
TYPED_TEST(Instances, AreNotHitByRaysThatLeaveThem) {
  using Real = TypeParam;
  Random random(7);
  size_t left = 0, hit_again = 0;
  while (left < effort(100'000)) {
    Scene described;
    Mesh mesh = icosphere(0);  // convex: outward rays hit nothing
    const double size = random.magnitude_between(1e-3, 1e3);
    const Vec3d place = random.on_sphere() * random.magnitude_between(1e-3, 1e2) * size;
    for (Vec3d& p : mesh.positions) p = p * size + place;
    described.meshes.push_back(std::move(mesh));
    described.groups.resize(2);
    Shape shape;
    shape.mesh = 0;
    described.groups[1].shapes.push_back(shape);
    for (int i = 0; i < 2; ++i) {
      Instance instance;
      instance.group = 1;
      // The second one is far away.
      const Transform placement =
          Transform::translate(random.on_sphere() * size * (i == 0 ? 1e2 : 1e6)) * random_placement(random, 1);
      instance.world_from_group = {placement, placement};
      if (random.below(2) == 0) instance.world_from_group.end = placement * Transform::rotate(20, random.on_sphere());
      described.instances.push_back(instance);
    }
    const CompiledScene<Real> scene = flat_instanced_scene<Real>(described, false);
    const MovingTransform& placement = described.instances[0].world_from_group;
    for (int i = 0; i < 200; ++i) {
      const double time = random.uniform<double>();
      const Vec3d within = place + random.on_sphere() * size * 0.7;
      const Vec3d target = lerp(placement.start.point(within), placement.end.point(within), time);
      const Vec3d origin = target + random.on_sphere() * size * random.magnitude_between(3, 100);
      const Ray<Real> ray{convert<Real>(origin), normalize(convert<Real>(target) - convert<Real>(origin)),
                          static_cast<Real>(time)};
      Hit<Real> hit;
      if (!BruteForceIntersector<Real>(scene.view).closest_hit(ray, infinity<Real>, hit) || hit.instance != 0) continue;
      const SurfaceInteraction<Real> si = surface_interaction(scene.view, ray, hit);
      // Outward is the side from which the ray came.
      const double side = dot(si.normal, ray.direction) < 0 ? 1 : -1;
      const Vec3<Real> direction = convert<Real>(random.on_hemisphere(convert<double>(si.normal) * side));
      const Ray<Real> leaving = spawn_ray(si, normalize(direction));
      ++left;
      hit_again += BruteForceIntersector<Real>(scene.view).occluded(leaving, static_cast<Real>(10 * size));
    }
  }
  EXPECT_EQ(hit_again, 0u) << "of " << left;
}

/// At any time they are where an instance with the interpolated matrix of shutter open and close would be.
TYPED_TEST(Instances, MoveAlongLines) {
  using Real = TypeParam;
  const Scene moving = instanced_scene(13, 30, reach, true);
  const CompiledScene<Real> scene = flat_instanced_scene<Real>(moving, false);
  const double tolerance = 2e4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  Random random(14);
  for (const double time : {0.0, 0.3, 1.0}) {
    Scene still = moving;
    for (Instance& instance : still.instances) {
      MovingTransform& placement = instance.world_from_group;
      Matrix4 matrix;
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j)
          matrix[i][j] = placement.start.matrix()[i][j] * (1 - time) + placement.end.matrix()[i][j] * time;
      placement.start = placement.end = Transform(matrix);
    }
    const CompiledScene<Real> frozen = flat_instanced_scene<Real>(still, false);
    size_t hit_count = 0, apart = 0;
    for (size_t i = 0; i < effort(5'000); ++i) {
      Ray<Real> ray = random_ray<Real>(random);
      ray.time = static_cast<Real>(time);
      Hit<Real> a, b;
      const bool found = Bvh2Intersector<Real>(scene.view).closest_hit(ray, infinity<Real>, a);
      if (Bvh2Intersector<Real>(frozen.view).closest_hit(ray, infinity<Real>, b) != found ||
          (found && std::abs(static_cast<double>(a.t - b.t)) > tolerance)) {
        ++apart;
        continue;
      }
      if (!found) continue;
      ++hit_count;
      const SurfaceInteraction<Real> of_moving = surface_interaction(scene.view, ray, a);
      const SurfaceInteraction<Real> of_still = surface_interaction(frozen.view, ray, b);
      ASSERT_LT(static_cast<double>(length(of_moving.position - of_still.position)), tolerance);
      if (a.primitive == b.primitive) {
        ASSERT_GT(dot(of_moving.normal, of_still.normal), Real(0.99));
      }
    }
    EXPECT_GT(hit_count, effort(5'000) / 10);
    EXPECT_LT(apart, hit_count / 500 + 3);
  }
}

TYPED_TEST(Instances, AMeshThatMovesIsOne) {
  Scene described = instanced_scene(15, 0, reach);
  Shape& ball = described.groups[0].shapes[0];
  ball.world_from_object.end = Transform::translate({1, 2, 3}) * ball.world_from_object.start;
  described.camera.shutter_open = 0.5;
  const CompiledScene<TypeParam> scene = flat_instanced_scene<TypeParam>(described, true);
  ASSERT_EQ(scene.view.instances_count, 1u);
  ASSERT_EQ(scene.view.instance_motions_count, 1u);
  EXPECT_EQ(scene.view.instances[0].world_from_object[1][3], TypeParam(1));
  EXPECT_EQ(scene.view.instance_motions[0].change[2][3], TypeParam(1.5));
}

TYPED_TEST(Instances, OfAFewTrianglesAreCopied) {
  Diagnostics diagnostics;
  CompileOptions options;
  const CompiledScene<TypeParam> scene = compile_scene<TypeParam>(instanced_scene(8, 10, reach), options, diagnostics);
  EXPECT_EQ(scene.view.instances_count, 0u);
  options.max_copied_triangles = 1000;
  EXPECT_EQ(compile_scene<TypeParam>(instanced_scene(8, 10, reach), options, diagnostics).view.instances_count, 10u);
}

TYPED_TEST(Instances, LeaveLightsAndSpheresInTheWorld) {
  Scene described = instanced_scene(9, 5, reach);
  Shape lamp = described.groups[1].shapes[1];
  lamp.emission = Emission{{1, 2, 3}};
  described.groups[1].shapes.push_back(lamp);
  Shape ball;
  ball.type = ShapeType::sphere;
  described.groups[1].shapes.push_back(ball);
  for (Instance& instance : described.instances) {
    const Transform placement = Transform::translate({3, 4, 5});
    instance.world_from_group = {placement, placement};
  }
  const CompiledScene<TypeParam> scene = flat_instanced_scene<TypeParam>(described, false);
  EXPECT_EQ(scene.view.spheres_count, 5u);
  EXPECT_EQ(scene.view.lights_count, 5 * described.meshes[1].triangle_count());
  EXPECT_EQ(scene.view.objects_count, 1u);
  for (uint32_t i = 0; i < scene.view.lights_count; ++i)
    EXPECT_LT(scene.view.lights[i].primitive, scene.view.objects[0].first_triangle);
}

}  // namespace
}  // namespace alhazen::impl::test
