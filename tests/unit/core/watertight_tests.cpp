// No ray passes between the triangles of a closed mesh: not at edges, not at vertices, not far from the origin. Nor
// does one pass through the side of a cylinder, not where u begins and ends, or between it and disks at its ends.

#include <gtest/gtest.h>

#include "core/integrators/stages.h"
#include "core/shapes/interaction.h"
#include "support/closed_meshes.h"
#include "support/effort.h"
#include "support/engines.h"
#include "support/primitive_scenes.h"

namespace alhazen::impl::test {
namespace {

enum class Aim { vertex, edge, face };

/// A point of the mesh's surface.
Vec3d target_on(const Mesh& mesh, Aim aim, Random& random) {
  const size_t triangle = 3 * random.below(static_cast<uint32_t>(mesh.triangle_count()));
  const auto corner = [&](size_t i) { return mesh.positions[mesh.indices[triangle + i]]; };
  if (aim == Aim::vertex) return corner(0);
  if (aim == Aim::edge) return lerp(corner(0), corner(1), random.uniform<double>());
  const double u = random.uniform<double>(), v = random.uniform<double>() * (1 - u);
  return corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
}

template <class Real>
struct Miss {
  size_t from_inside = 0, from_outside = 0;
};

/// Rays at the mesh, which is star-shaped about `centre` and about as large as `radius`: from points in its inner half,
/// and from outside in directions that lead through the inner half.
template <class Tree, class Real = typename Tree::Real>
Miss<Real> shoot(const SceneView<Real>& scene, const Mesh& mesh, const Vec3d& centre, double radius, Aim aim,
                 size_t rays, Random& random) {
  const typename Tree::Intersector bvh(scene);
  Miss<Real> misses;
  for (size_t i = 0; i < rays; ++i) {
    // Numbers generated in double are rounded first, so that the ray aims at what the scene contains.
    const Vec3<Real> target = convert<Real>(target_on(mesh, aim, random));
    const Vec3<Real> inside = convert<Real>(centre + random.on_sphere() * (random.uniform<double>() * 0.5 * radius));
    const Vec3<Real> outwards = normalize(target - inside);
    Hit<Real> hit;
    if (!bvh.closest_hit({inside, outwards}, infinity<Real>, hit)) ++misses.from_inside;
    const Real distance = static_cast<Real>(radius * random.magnitude_between(1, 30));
    const Vec3<Real> outside = target + outwards * distance;
    const Vec3<Real> inwards = normalize(target - outside);
    if (!bvh.closest_hit({outside, inwards}, infinity<Real>, hit)) ++misses.from_outside;
  }
  return misses;
}

template <class Tree>
void check_watertight(double jitter, double radius, const Vec3d& centre, uint64_t seed) {
  using Real = typename Tree::Real;
  Random random(seed);
  Mesh mesh = icosphere(4);
  jitter_radii(mesh, jitter, random);
  for (Vec3d& p : mesh.positions) p = p * radius + centre;
  PrimitiveScene primitives;
  primitives.add_mesh(mesh);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  for (const Aim aim : {Aim::vertex, Aim::edge, Aim::face}) {
    const Miss<Real> misses = shoot<Tree>(scene.view, mesh, centre, radius, aim, effort(100'000), random);
    EXPECT_EQ(misses.from_inside, 0u) << "aim " << static_cast<int>(aim);
    EXPECT_EQ(misses.from_outside, 0u) << "aim " << static_cast<int>(aim);
  }
}

const Vec3d far_away{1.5e5, -1.5e5, 1.5e5};

template <class Tree>
class WatertightOf : public ::testing::Test {};
TYPED_TEST_SUITE(WatertightOf, Engines);

TYPED_TEST(WatertightOf, Icosphere) { check_watertight<TypeParam>(0, 1, {}, 1); }
TYPED_TEST(WatertightOf, IcosphereFarAway) { check_watertight<TypeParam>(0, 100, far_away, 2); }
TYPED_TEST(WatertightOf, Jittered) { check_watertight<TypeParam>(0.02, 1, {}, 3); }
TYPED_TEST(WatertightOf, JitteredFarAway) { check_watertight<TypeParam>(0.02, 100, far_away, 4); }

/// Rays from the inner half of a cylinder and from outside, half of them towards points where u begins and ends.
template <class Tree>
void check_cylinder(const Transform& world, uint64_t seed) {
  using Real = typename Tree::Real;
  Random random(seed);
  PrimitiveScene primitives;
  primitives.add_cylinder(world);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const typename Tree::Intersector bvh(scene.view);
  size_t misses = 0;
  for (size_t i = 0; i < effort(100'000); ++i) {
    const double phi = random.below(2) ? 0 : random.between(0, 2 * pi<double>), z = random.between(-0.9, 0.9);
    const Vec3d within = random.on_sphere() * 0.5;
    const Vec3<Real> target = convert<Real>(world.point({std::cos(phi), std::sin(phi), z}));
    const Vec3<Real> inside = convert<Real>(world.point(within));
    const Vec3<Real> outside = target + (target - inside) * static_cast<Real>(random.magnitude_between(0.1, 30));
    Hit<Real> hit;
    misses += !bvh.closest_hit({inside, normalize(target - inside)}, infinity<Real>, hit);
    misses += !bvh.closest_hit({outside, normalize(target - outside)}, infinity<Real>, hit);
  }
  EXPECT_EQ(misses, 0u);
}

TYPED_TEST(WatertightOf, Cylinder) { check_cylinder<TypeParam>({}, 5); }
TYPED_TEST(WatertightOf, SkewedCylinderFarAway) {
  Random random(6);
  check_cylinder<TypeParam>(random_cylinder(far_away, 100, random), 6);
}

/// Rays within a can of a cylinder and two disks, half of them towards the rims: from points inside, and from where
/// those hit, as many times as reflections would. Rays from outside through the rim do not hit the far side.
template <class Tree>
void check_can(const Transform& world, uint64_t seed) {
  using Real = typename Tree::Real;
  Random random(seed);
  PrimitiveScene primitives;
  primitives.add_cylinder(world);
  for (const double height : {-1.0, 1.0}) primitives.add_disk(world, 0, 360, height);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const typename Tree::Intersector bvh(scene.view);
  const auto on_cylinder = [&](double z) {
    const double phi = random.between(0, 2 * pi<double>);
    return world.point({std::cos(phi), std::sin(phi), z});
  };
  const auto on_rim = [&] { return on_cylinder(random.below(2) ? 1 : -1); };
  size_t misses = 0, reflected_misses = 0, passed = 0;
  for (size_t i = 0; i < effort(100'000); ++i) {
    const Vec3<Real> inside = convert<Real>(world.point(random.on_sphere() * (random.uniform<double>() * 0.9)));
    const Vec3<Real> target = convert<Real>(random.below(2) ? on_rim() : on_cylinder(random.between(-1, 1)));
    Ray<Real> ray{inside, normalize(target - inside)};
    Hit<Real> hit;
    for (int bounce = 0; bounce < 6; ++bounce) {
      if (!bvh.closest_hit(ray, infinity<Real>, hit)) {
        ++(bounce == 0 ? misses : reflected_misses);
        break;
      }
      const SurfaceInteraction<Real> si = surface_interaction(scene.view, ray, hit);
      const Vec3<Real> inward = dot(si.normal, ray.direction) < 0 ? si.normal : -si.normal;
      Vec3<Real> direction = normalize(convert<Real>(on_rim()) - si.position);
      if (random.below(2) || !(dot(direction, inward) > Real(1e-5)))
        direction = normalize(convert<Real>(random.on_hemisphere(convert<double>(inward))));
      if (!(dot(direction, inward) > 0)) break;
      ray = spawn_ray(si, direction);
    }
    const Vec3<Real> outside = target + (target - inside) * static_cast<Real>(random.magnitude_between(0.1, 30));
    const Ray<Real> back{outside, normalize(inside - outside)};
    passed += !bvh.closest_hit(back, infinity<Real>, hit) || hit.t > length(inside - outside);
  }
  EXPECT_EQ(misses, 0u);
  EXPECT_EQ(reflected_misses, 0u);
  EXPECT_EQ(passed, 0u);
}

const Transform turned = Transform::rotate(33, {1, 2, 3});

TYPED_TEST(WatertightOf, Can) { check_can<TypeParam>({}, 7); }
TYPED_TEST(WatertightOf, TurnedCan) { check_can<TypeParam>(turned, 8); }
TYPED_TEST(WatertightOf, StretchedCan) { check_can<TypeParam>(turned * Transform::scale({1, 2, 0.5}), 9); }
TYPED_TEST(WatertightOf, SkewedCan) {
  Random random(10);
  check_can<TypeParam>(random_cylinder({3, 4, -5}, 1, random), 10);
}
TYPED_TEST(WatertightOf, TallCan) {
  check_can<TypeParam>(turned * Transform::translate({0, 0, 100}) * Transform::scale({1, 1, 100}), 11);
}
TYPED_TEST(WatertightOf, FlatCan) { check_can<TypeParam>(turned * Transform::scale({100, 100, 1}), 12); }
TYPED_TEST(WatertightOf, CanFarAway) { check_can<TypeParam>(Transform::translate({1000, -500, 2000}) * turned, 13); }

// From the exact centre of a mesh about the origin the direction to a vertex is exact: edge functions become 0.
TYPED_TEST(WatertightOf, ExactlyThroughVertices) {
  using Real = typename TypeParam::Real;
  const Mesh mesh = icosphere(4);
  PrimitiveScene primitives;
  primitives.add_mesh(mesh);
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const typename TypeParam::Intersector bvh(scene.view);
  Hit<Real> hit;
  for (const Vec3d& p : mesh.positions) {
    // The direction need not have unit length for this.
    EXPECT_TRUE(bvh.closest_hit({{}, convert<Real>(p)}, infinity<Real>, hit));
    EXPECT_TRUE(bvh.closest_hit({{}, normalize(convert<Real>(p))}, infinity<Real>, hit));
  }
}

}  // namespace
}  // namespace alhazen::impl::test
