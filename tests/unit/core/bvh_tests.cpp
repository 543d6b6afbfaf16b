// The BVHs find the hits of a linear scan, for any scene and ray.

#include <gtest/gtest.h>

#include "core/bvh/brute_force/intersector.h"
#include "support/effort.h"
#include "support/engines.h"
#include "support/primitive_scenes.h"
#include "support/ulps.h"

namespace alhazen::impl::test {
namespace {

template <class Tree>
class BvhOf : public ::testing::Test {};
TYPED_TEST_SUITE(BvhOf, Engines);

template <class Real>
Ray<Real> ray_from(const Vec3d& origin, const Vec3d& direction, double time = 0) {
  return {convert<Real>(origin), normalize(convert<Real>(direction)), static_cast<Real>(time)};
}

/// Expects that both intersectors agree on the ray. Returns whether it hits anything.
template <class Tree, class Real = typename Tree::Real>
bool expect_same(const SceneView<Real>& scene, const Ray<Real>& ray, Real t_max = infinity<Real>) {
  const typename Tree::Intersector bvh(scene);
  const BruteForceIntersector<Real> linear(scene);
  Hit<Real> hit, expected;
  const bool was_hit = bvh.closest_hit(ray, t_max, hit), expect_hit = linear.closest_hit(ray, t_max, expected);
  EXPECT_EQ(was_hit, expect_hit);
  EXPECT_EQ(bvh.occluded(ray, t_max), expect_hit);
  EXPECT_EQ(linear.occluded(ray, t_max), expect_hit);
  if (was_hit && expect_hit && !(hit.primitive == expected.primitive)) {
    EXPECT_LE(ulps_between(hit.t, expected.t), 16u) << hit.t << " instead of " << expected.t;
  }
  if (was_hit && expect_hit && hit.primitive == expected.primitive) {
    EXPECT_EQ(hit.t, expected.t);
  }
  return expect_hit;
}

/// Rays from a box about the origin, half of them towards objects in the inner part of it.
template <class Real>
Ray<Real> random_ray(Random& random, double size) {
  const Vec3d origin = random.in_box(-size, size);
  const Vec3d direction =
      random.uniform<double>() < 0.5 ? random.on_sphere() : normalize(random.in_box(-0.5, 0.5) * size - origin);
  return ray_from<Real>(origin, direction, random.uniform<double>());
}

TYPED_TEST(BvhOf, MixedPrimitives) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = mixed_primitives(7, 200).flat<Real>();
  Random random(8);
  size_t hit_count = 0;
  for (size_t i = 0; i < effort(100'000); ++i) {
    hit_count += expect_same<TypeParam>(scene.view, random_ray<Real>(random, 15));
    if (this->HasFailure()) break;
  }
  EXPECT_GT(hit_count, effort(20'000));
}

TYPED_TEST(BvhOf, LimitedDistance) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = mixed_primitives(9, 200).flat<Real>();
  Random random(10);
  for (size_t i = 0; i < effort(20'000); ++i)
    expect_same<TypeParam>(scene.view, random_ray<Real>(random, 15),
                           static_cast<Real>(random.magnitude_between(0.1, 30)));
}

/// A hit just at t_max does not count, one just before it does.
TYPED_TEST(BvhOf, DistanceIsExclusive) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  primitives.add_triangle({-1, -1, 5}, {1, -1, 5}, {0, 1, 5});
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const typename TypeParam::Intersector bvh(scene.view);
  const Ray<Real> ray = ray_from<Real>({}, {0, 0, 1});
  Hit<Real> hit;
  ASSERT_TRUE(bvh.closest_hit(ray, infinity<Real>, hit));
  EXPECT_EQ(hit.t, Real(5));
  EXPECT_FALSE(bvh.closest_hit(ray, Real(5), hit));
  EXPECT_FALSE(bvh.occluded(ray, Real(5)));
  EXPECT_TRUE(bvh.occluded(ray, std::nextafter(Real(5), Real(6))));
}

/// Directions along axes and in planes have zeros, whose reciprocals are infinite.
TYPED_TEST(BvhOf, RaysAlongAxes) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  for (int x = -4; x < 4; ++x)
    for (int y = -4; y < 4; ++y) {
      primitives.add_triangle({x + 0.0, y + 0.0, 0}, {x + 1.0, y + 0.0, 0}, {x + 0.0, y + 1.0, 0});
      primitives.add_triangle({0, x + 0.0, y + 0.0}, {0, x + 1.0, y + 0.0}, {0, x + 0.0, y + 1.0});
    }
  primitives.add_sphere({2, 2, 2}, 1);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  Random random(11);
  for (size_t i = 0; i < effort(20'000); ++i) {
    Vec3d origin{}, direction{};
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = random.below(13) * 0.5 - 3;  // often in a plane of the grid, on its edges and vertices
      direction[axis] = random.below(3) - 1.0;
      if (direction[axis] == 0 && random.below(2)) direction[axis] = -0.0;
    }
    if (!is_zero(direction)) expect_same<TypeParam>(scene.view, ray_from<Real>(origin, direction));
  }
}

TYPED_TEST(BvhOf, EmptyScene) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = PrimitiveScene().flat<Real>();
  EXPECT_EQ(scene.view.bvh2_nodes_count, 0u);
  EXPECT_FALSE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {1, 2, 3})));
}

TYPED_TEST(BvhOf, OnePrimitive) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  primitives.add_sphere({0, 0, 3}, 1);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  EXPECT_TRUE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {0, 0, 1})));
  EXPECT_FALSE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {0, 1, 0})));
}

TYPED_TEST(BvhOf, AllAtOnePoint) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  Random random(12);
  for (int i = 0; i < 300; ++i) primitives.add_sphere({1, 2, 3}, random.magnitude_between(0.1, 2));
  const CompiledScene<Real> scene = primitives.flat<Real>();
  for (int i = 0; i < 2000; ++i) expect_same<TypeParam>(scene.view, random_ray<Real>(random, 5));
}

TYPED_TEST(BvhOf, IdenticalBoxes) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) primitives.add_triangle({-1, -1, 2}, {1, -1, 2}, {0, 1, 2});
  const CompiledScene<Real> scene = primitives.flat<Real>();
  EXPECT_TRUE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {0, 0, 1})));
  EXPECT_TRUE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {0.01, 0.02, 1})));
  EXPECT_FALSE(expect_same<TypeParam>(scene.view, ray_from<Real>({}, {0, 0, -1})));
}

/// Returns whether the next precision agrees on a hit. Triangles seen edge-on, and large ones close by, may appear to
/// be hit outside their boxes.
template <class Real>
bool is_sure(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit) {
  using Wide = std::conditional_t<sizeof(Real) == sizeof(float), double, long double>;
  if (hit.primitive.kind() != PrimitiveKind::triangle) return true;
  const uint32_t* const v = scene.triangles[hit.primitive.index()].vertex;
  const auto vertex = [&](int i) { return convert<Wide>(scene.positions[v[i]]); };
  const Ray<Wide> wide{convert<Wide>(ray.origin), convert<Wide>(ray.direction)};
  Wide t = 0, b1 = 0, b2 = 0;
  return intersect_triangle(shear_ray(wide, 0), vertex(0), vertex(1), vertex(2), std::numeric_limits<Wide>::max(), t,
                            b1, b2) &&
         std::abs(static_cast<Wide>(hit.t) - t) < Wide(1e-3) * t;
}

/// Sizes from 1e-8 to 1e12 in one scene. (Triangles below 1e-11 have no area in float and are omitted.)
TYPED_TEST(BvhOf, HugeRangeOfSizes) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  Random random(13);
  const double largest = sizeof(Real) == sizeof(float) ? 1e9 : 1e12;  // larger triangles are refused
  for (int i = 0; i < 300; ++i) {
    const double size = random.magnitude_between(1e-8, largest);
    const Vec3d p = random.on_sphere() * size;
    primitives.add_triangle(p, p + random.on_sphere() * size, p + random.on_sphere() * size);
    primitives.add_sphere(random.on_sphere() * size, 0.3 * size);
  }
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const BruteForceIntersector<Real> linear(scene.view);
  size_t sure = 0;
  for (size_t i = 0; i < effort(20'000); ++i) {
    const Vec3d origin = random.on_sphere() * random.magnitude_between(1e-8, 1e12);
    const Ray<Real> ray = ray_from<Real>(origin, random.on_sphere());
    Hit<Real> hit;
    if (linear.closest_hit(ray, infinity<Real>, hit) && !is_sure(scene.view, ray, hit)) continue;
    ++sure;
    expect_same<TypeParam>(scene.view, ray);
  }
  EXPECT_GT(sure, effort(19'000));
}

/// NaN and infinity in every component: traversal ends, with any result.
TYPED_TEST(BvhOf, RaysThatAreNoRays) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = mixed_primitives(14, 50).flat<Real>();
  const typename TypeParam::Intersector bvh(scene.view);
  Random random(15);
  const Real strange[] = {
      std::numeric_limits<Real>::quiet_NaN(), infinity<Real>, -infinity<Real>,
      std::numeric_limits<Real>::max(),       Real(0),        std::numeric_limits<Real>::denorm_min()};
  for (size_t i = 0; i < effort(20'000); ++i) {
    Ray<Real> ray = random_ray<Real>(random, 15);
    Real* components[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z, &ray.direction.x,
                          &ray.direction.y, &ray.direction.z, &ray.time};
    for (uint32_t changes = 1 + random.below(3); changes > 0; --changes)
      *components[random.below(7)] = strange[random.below(6)];
    Hit<Real> hit;
    if (bvh.closest_hit(ray, infinity<Real>, hit)) {
      EXPECT_GT(hit.t, Real(0));
      EXPECT_FALSE(hit.primitive.is_none());
    }
    bvh.occluded(ray, random.below(2) ? infinity<Real> : std::numeric_limits<Real>::quiet_NaN());
  }
}

}  // namespace
}  // namespace alhazen::impl::test
