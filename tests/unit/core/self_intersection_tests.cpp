// A ray that starts on a surface does not hit it again at its origin, over many magnitudes of size and distance. The
// starting point is the hit of a ray, as in a render.

#include <gtest/gtest.h>

#include <optional>

#include "core/bvh/brute_force/intersector.h"
#include "core/integrators/stages.h"
#include "support/effort.h"
#include "support/primitive_scenes.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

/// A single primitive, on the stack.
template <class Real>
struct OnePrimitive {
  Vec3<Real> positions[3];
  TriangleRecord triangle{{0, 1, 2}, 0};
  SphereRecord<Real> sphere{{}, 0, 0, no_sphere_frame};
  SurfaceRecord surface{0, no_light, no_offset, no_offset, 0, no_offset};
  PrimitiveId primitive;

  SceneView<Real> view() const {
    SceneView<Real> view;
    view.positions = positions;
    view.triangles = &triangle;
    view.spheres = &sphere;
    view.surfaces = &surface;
    view.primitives = &primitive;
    view.primitives_count = 1;
    return view;
  }
};

/// A direction on the given side of the surface, one in four grazing.
template <class Real>
Vec3<Real> leaving_direction(const Vec3<Real>& normal, double side, Random& random) {
  const Vec3d n = convert<double>(normal) * side;
  Vec3d w = random.on_hemisphere(n);
  if (random.below(4) == 0) {
    const Vec3d along = normalize(w - n * dot(w, n));
    w = normalize(along + n * random.magnitude_between(1e-7, 1e-2));
  }
  Vec3<Real> direction = normalize(convert<Real>(w));
  // Rounding may have moved it to the other side.
  return dot(direction, normal) * static_cast<Real>(side) < 0 ? -direction : direction;
}

/// The hit of a ray from `distance` away towards about `target`, if there is one.
template <class Real>
std::optional<SurfaceInteraction<Real>> meet(const SceneView<Real>& scene, const Vec3d& target, double distance,
                                             Random& random) {
  const Vec3d origin = target + random.on_sphere() * distance;
  const Vec3<Real> o = convert<Real>(origin);
  const Ray<Real> ray{o, normalize(convert<Real>(target) - o)};
  Hit<Real> hit;
  if (!is_finite(ray.direction) || !BruteForceIntersector<Real>(scene).closest_hit(ray, infinity<Real>, hit))
    return std::nullopt;
  return surface_interaction(scene, ray, hit);
}

/// Below this size a shape at `position` is mostly rounding of coordinates.
template <class Real>
double min_resolved_size(const Vec3d& position) {
  return 100 * length(position) * static_cast<double>(std::numeric_limits<Real>::epsilon());
}

template <class Real>
class SelfIntersectionOf : public ::testing::Test {};
TYPED_TEST_SUITE(SelfIntersectionOf, Reals);

TYPED_TEST(SelfIntersectionOf, Triangles) {
  using Real = TypeParam;
  Random random(1);
  size_t left = 0, hit_again = 0;
  OnePrimitive<Real> scene;
  scene.primitive = PrimitiveId(PrimitiveKind::triangle, 0);
  while (left < effort(1'000'000)) {
    const Vec3d p = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
    const double size = random.magnitude_between(1e-4, 1e4);
    const Vec3d corners[3] = {p, p + random.on_sphere() * size, p + random.on_sphere() * size};
    for (int i = 0; i < 3; ++i) scene.positions[i] = convert<Real>(corners[i]);
    const SceneView<Real> view = scene.view();
    if (!(length(triangle_cross(view, scene.triangle)) > 0)) continue;  // the scene compiler omits these
    for (int i = 0; i < 16; ++i) {
      const Vec2d b = sample_triangle(random.uniform_2d<double>());
      const Vec3d target = corners[0] * b.x + corners[1] * b.y + corners[2] * (1 - b.x - b.y);
      const auto si = meet<Real>(view, target, size * random.magnitude_between(0.1, 100), random);
      if (!si) continue;
      for (const double side : {1.0, -1.0}) {
        const Ray<Real> ray = spawn_ray(*si, leaving_direction(si->normal, side, random));
        ++left;
        hit_again += BruteForceIntersector<Real>(view).occluded(ray, infinity<Real>);
      }
    }
  }
  EXPECT_EQ(hit_again, 0u) << "of " << left;
}

TYPED_TEST(SelfIntersectionOf, SpheresFromOutside) {
  using Real = TypeParam;
  Random random(2);
  size_t left = 0, hit_again = 0;
  OnePrimitive<Real> scene;
  scene.primitive = PrimitiveId(PrimitiveKind::sphere, 0);
  while (left < effort(1'000'000)) {
    const Vec3d centre = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
    const double radius = random.magnitude_between(1e-3, 1e4);
    scene.sphere.centre = convert<Real>(centre);
    scene.sphere.radius = static_cast<Real>(radius);
    const SceneView<Real> view = scene.view();
    for (int i = 0; i < 16; ++i) {
      const Vec3d target = centre + random.on_sphere() * radius;
      const auto si = meet<Real>(view, target, radius * random.magnitude_between(0.1, 100), random);
      if (!si) continue;
      const Ray<Real> ray = spawn_ray(*si, leaving_direction(si->normal, 1, random));
      ++left;
      hit_again += BruteForceIntersector<Real>(view).occluded(ray, infinity<Real>);
    }
  }
  EXPECT_EQ(hit_again, 0u) << "of " << left;
}

/// An inward ray hits the far side, after 2 r cos, not the near side again. Spheres must be larger than the resolution
/// of positions, or there is no inside.
TYPED_TEST(SelfIntersectionOf, SpheresFromInside) {
  using Real = TypeParam;
  Random random(3);
  size_t left = 0, hit_again = 0;
  OnePrimitive<Real> scene;
  scene.primitive = PrimitiveId(PrimitiveKind::sphere, 0);
  while (left < effort(1'000'000)) {
    const Vec3d centre = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
    const double radius = random.magnitude_between(1e-3, 1e4);
    if (radius < min_resolved_size<Real>(centre)) continue;
    scene.sphere.centre = convert<Real>(centre);
    scene.sphere.radius = static_cast<Real>(radius);
    const SceneView<Real> view = scene.view();
    for (int i = 0; i < 16; ++i) {
      const Vec3d target = centre + random.on_sphere() * radius;
      const auto si = meet<Real>(view, target, radius * random.magnitude_between(0.1, 100), random);
      if (!si) continue;
      const Ray<Real> ray = spawn_ray(*si, leaving_direction(si->normal, -1, random));
      ++left;
      const double chord = 2 * radius * static_cast<double>(abs_dot(ray.direction, si->normal));
      hit_again += BruteForceIntersector<Real>(view).occluded(ray, static_cast<Real>(chord / 2));
    }
  }
  EXPECT_EQ(hit_again, 0u) << "of " << left;
}

/// Calls check(view, si, n) for hits of cylinders by rays from all around, where `view` holds nothing but that
/// cylinder: skewed, mirrored and far from the origin, whole or in part, as long and thin as 1 to 9.
template <class Real, class Check>
void at_points_of_cylinders(uint64_t seed, bool only_resolved, const Check& check) {
  Random random(seed);
  size_t left = 0;
  while (left < effort(1'000'000)) {
    PrimitiveScene primitives;
    for (int i = 0; i < 4096; ++i) {
      const Vec3d centre = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
      const double size = random.magnitude_between(1e-3, 1e4);
      if (only_resolved && size < 20 * min_resolved_size<Real>(centre)) continue;
      primitives.add_cylinder(random_cylinder(centre, size, random), i % 2 == 0 ? 360 : random.between(1, 360));
    }
    const CompiledScene<Real> scene = primitives.flat<Real>();
    for (uint32_t i = 0; i < scene.view.cylinders_count; ++i) {
      const PrimitiveId id(PrimitiveKind::cylinder, i);
      SceneView<Real> view = scene.view;
      view.primitives = &id;
      view.primitives_count = 1;
      const Bounds3<Real> box = bounds_of(view, view.cylinders[i]);
      const double size = static_cast<double>(length(box.diagonal()));
      for (int n = 0; n < 16; ++n) {
        const Vec3d target = convert<double>(box.centre()) + random.on_sphere() * (random.uniform<double>() * size / 2);
        const auto si = meet<Real>(view, target, size * random.magnitude_between(0.1, 100), random);
        if (!si) continue;
        ++left;
        check(view, *si, random);
      }
    }
  }
}

TYPED_TEST(SelfIntersectionOf, CylindersFromOutside) {
  using Real = TypeParam;
  size_t hit_again = 0;
  at_points_of_cylinders<Real>(5, false,
                               [&](const SceneView<Real>& view, const SurfaceInteraction<Real>& si, Random& random) {
                                 const Ray<Real> ray = spawn_ray(si, leaving_direction(si.normal, 1, random));
                                 hit_again += BruteForceIntersector<Real>(view).occluded(ray, infinity<Real>);
                               });
  EXPECT_EQ(hit_again, 0u);
}

/// An inward ray hits the far side, or leaves through an end or a gap. In object space, the chord from a point with the
/// normal n in the direction d has the length 2 |n d| / |d|^2 in two dimensions.
TYPED_TEST(SelfIntersectionOf, CylindersFromInside) {
  using Real = TypeParam;
  size_t hit_again = 0;
  at_points_of_cylinders<Real>(
      6, true, [&](const SceneView<Real>& view, const SurfaceInteraction<Real>& si, Random& random) {
        const CylinderRecord<Real>& cylinder = view.cylinders[si.primitive.index()];
        const Ray<Real> ray = spawn_ray(si, leaving_direction(si.normal, -1, random));
        const Vec3d n = convert<double>(object_point(cylinder, si.position - cylinder.anchor));
        const Vec3d d = convert<double>(object_from_world(cylinder, ray.direction));
        const double chord = 2 * std::abs(n.x * d.x + n.y * d.y) / (d.x * d.x + d.y * d.y);
        hit_again += BruteForceIntersector<Real>(view).occluded(ray, static_cast<Real>(chord / 2));
      });
  EXPECT_EQ(hit_again, 0u);
}

TYPED_TEST(SelfIntersectionOf, Disks) {
  using Real = TypeParam;
  Random random(7);
  size_t left = 0, hit_again = 0;
  while (left < effort(1'000'000)) {
    PrimitiveScene primitives;
    for (int i = 0; i < 4096; ++i) {
      const Vec3d centre = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
      const double size = random.magnitude_between(1e-3, 1e4);
      const Transform world = i % 4 == 0 ? Transform::translate(centre) * Transform::scale(splat(size))
                                         : random_cylinder(centre, size, random);
      primitives.add_disk(world, i % 3 == 0 ? 0.3 : 0, i % 2 == 0 ? 360 : random.between(1, 360));
    }
    const CompiledScene<Real> scene = primitives.flat<Real>();
    for (uint32_t i = 0; i < scene.view.disks_count; ++i) {
      const PrimitiveId id(PrimitiveKind::disk, i);
      SceneView<Real> view = scene.view;
      view.primitives = &id;
      view.primitives_count = 1;
      const Bounds3<Real> box = bounds_of(view, view.disks[i]);
      const double size = static_cast<double>(length(box.diagonal()));
      for (int n = 0; n < 16; ++n) {
        const Vec3d target = convert<double>(box.centre()) + random.on_sphere() * (random.uniform<double>() * size / 2);
        const auto si = meet<Real>(view, target, size * random.magnitude_between(0.1, 100), random);
        if (!si) continue;
        for (const double side : {1.0, -1.0}) {
          const Ray<Real> ray = spawn_ray(*si, leaving_direction(si->normal, side, random));
          ++left;
          hit_again += BruteForceIntersector<Real>(view).occluded(ray, infinity<Real>);
        }
      }
    }
  }
  EXPECT_EQ(hit_again, 0u) << "of " << left;
}

/// A sampled point of a light is visible if nothing is in between: the light does not occlude itself.
TYPED_TEST(SelfIntersectionOf, LightsAreSeen) {
  using Real = TypeParam;
  Random random(4);
  size_t hidden = 0, tried = 0;
  OnePrimitive<Real> scene;
  while (tried < effort(1'000'000)) {
    const bool round = random.below(2) == 0;
    scene.primitive = PrimitiveId(round ? PrimitiveKind::sphere : PrimitiveKind::triangle, 0);
    const Vec3d p = random.on_sphere() * random.magnitude_between(1e-3, 1e5);
    const double size = random.magnitude_between(1e-2, 1e3);
    if (size < min_resolved_size<Real>(p)) continue;
    scene.sphere.centre = convert<Real>(p);
    scene.sphere.radius = static_cast<Real>(size);
    for (Vec3<Real>& corner : scene.positions) corner = convert<Real>(p + random.on_sphere() * size);
    SceneView<Real> view = scene.view();
    if (!round && !(length(triangle_cross(view, scene.triangle)) > 0)) continue;
    LightRecord<Real> light{};
    light.kind = round ? LightKind::sphere : LightKind::triangle;
    light.radiance = splat(Real(1));
    light.two_sided = 1;
    light.pmf = 1;
    view.lights = &light;
    view.lights_count = 1;
    const TriangleEmitter<Real> emitter = make_triangle_emitter(view, light);
    view.triangle_emitters = &emitter;
    SurfaceInteraction<Real> from{};
    const double distance = size * random.magnitude_between(1.1, 1000);
    from.position = convert<Real>(p + random.on_sphere() * distance);
    from.position_error = abs(from.position) * rounding_bound<Real>(7);
    for (int i = 0; i < 16; ++i) {
      const LightSample<Real> s = sample_light(view, from.position, Vec3<Real>{}, Real(0), random.uniform_2d<Real>());
      if (!(s.pdf > 0)) continue;
      from.normal = s.direction;
      ++tried;
      hidden += !is_unoccluded(BruteForceIntersector<Real>(view), shadow_ray(from, s));
    }
  }
  EXPECT_EQ(hidden, 0u) << "of " << tried;
}

/// The third corner is so close to the first that the edges to the second are equal after rounding.
TYPED_TEST(SelfIntersectionOf, NeedlesHaveFinitePoints) {
  using Real = TypeParam;
  const Real tiny = std::is_same_v<Real, float> ? Real(1) : Real(1e-9);
  const Vec3<Real> p[3] = {{0, 0, 0}, {100, 70, 30}, {Real(2e-6) * tiny, Real(1e-6) * tiny, 0}};
  ASSERT_GT(length(cross(p[1] - p[0], p[2] - p[0])), Real(0));
  const TriangleCorners<Real> corners{{p[0], p[1], p[2]}, {}, 0, 0};
  for (const Real b1 : {Real(0), Real(0.3), Real(1)}) {
    const SurfaceInteraction<Real> si = point_of_triangle(corners, b1, Real(0.5) * (1 - b1));
    EXPECT_TRUE(is_finite(si.position)) << b1;
    EXPECT_LT(length(si.position - p[1] * b1),
              max_corner_offset<Real> * edge_clearance<Real> * max_component(si.position_error))
        << b1;
  }
}

/// Triangles that are narrower than the rounding error of their points: a push away from the short edge leaves them.
TYPED_TEST(SelfIntersectionOf, PointsOfSliversStayWhereTheyAre) {
  using Real = TypeParam;
  const auto move = [](const Vec3<Real>(&p)[3], Real b1, Real b2) {
    const TriangleCorners<Real> corners{{p[0], p[1], p[2]}, {}, 0, 0};
    const Vec3<Real> plain = point_in_plane(corners, b1, b2).position;
    const SurfaceInteraction<Real> si = point_of_triangle(corners, b1, b2);
    return length(si.position - plain) / (edge_clearance<Real> * max_component(si.position_error));
  };
  const Vec3<Real> sliver[3] = {{Real(4.36803818), Real(4.2008853), Real(4.72660685)},
                                {Real(257.499176), Real(-13.219574), Real(573.358521)},
                                {Real(256.192566), Real(-13.1296883), Real(570.423218)}};
  EXPECT_LT(move(sliver, Real(0.292719007), Real(0.424934626)), 2 * max_corner_offset<Real>);
  Random random(5);
  for (int i = 0; i < 100'000; ++i) {
    Vec3<Real> p[3];
    for (Vec3<Real>& corner : p) corner = convert<Real>(random.on_sphere() * random.magnitude_between(1, 1000));
    const auto shift = static_cast<Real>(random.magnitude_between(1e-9, 1));
    p[2] = p[0] + (p[1] - p[0]) * static_cast<Real>(random.uniform<double>()) + (p[2] - p[0]) * shift;
    if (!(length(cross(p[1] - p[0], p[2] - p[0])) > 0)) continue;
    const Vec2<Real> b = sample_triangle(Vec2<Real>{random.uniform<Real>(), random.uniform<Real>()});
    ASSERT_LT(move(p, b.x, b.y), 2 * max_corner_offset<Real>) << i;
  }
}

/// Another triangle in the same plane along two axes, where the starting point has no error along the normal: as with
/// overlapping walls. Needles seen edge-on may still be hit.
TYPED_TEST(SelfIntersectionOf, WhatLiesInThePlaneIsNotHit) {
  using Real = TypeParam;
  Random random(21);
  size_t left = 0, hit = 0;
  while (left < effort(200'000)) {
    const double height = random.below(2) == 0 ? 0 : random.uniform<double>() * 100;
    const double size = random.magnitude_between(1e-2, 1e2);
    const uint32_t axis = random.below(3);
    const auto corner = [&] {
      const double a = size * (2 * random.uniform<double>() - 1), b = size * (2 * random.uniform<double>() - 1);
      return convert<Real>(axis == 0 ? Vec3d{height, a, b} : axis == 1 ? Vec3d{a, height, b} : Vec3d{a, b, height});
    };
    const Vec3<Real> p[3] = {corner(), corner(), corner()};
    const Vec3<Real> winding = cross(p[1] - p[0], p[2] - p[0]);
    if (!(length(winding) > static_cast<Real>(0.1 * size * size))) continue;
    const TriangleCorners<Real> corners{{p[0], p[1], p[2]}, {}, 0, 0};
    const Vec2<Real> b = sample_triangle(random.uniform_2d<Real>());
    const SurfaceInteraction<Real> si = point_of_triangle(corners, b.x, b.y);
    const Ray<Real> ray = spawn_ray(si, leaving_direction(si.normal, random.below(2) == 0 ? 1.0 : -1.0, random));
    Real t, b1, b2;
    ++left;
    hit += intersect_triangle(shear_ray(ray, 0), p[0], p[1], p[2], infinity<Real>, t, b1, b2);
  }
  EXPECT_LT(hit, left / 1000) << "of " << left;
}

/// A long wall, turned, so that its vertices are rounded: rays from one of its triangles pass over the other.
TYPED_TEST(SelfIntersectionOf, TheOtherHalfOfALongWallIsNotHit) {
  using Real = TypeParam;
  Random random(22);
  size_t hit = 0;
  const size_t rays = effort(1'000'000);
  const double length = std::is_same_v<Real, float> ? 1e3 : 1e9;
  const Transform turned = Transform::rotate(33, normalize(Vec3d{1, 2, 3}));
  const auto corner = [&](double x, double y) { return convert<Real>(turned.point({x, y * length, -1})); };
  const Vec3<Real> p[4] = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
  const TriangleCorners<Real> half{{p[0], p[1], p[2]}, {}, 0, 0};
  for (size_t i = 0; i < rays; ++i) {
    const double b1 = random.magnitude_between(1e-6, 0.1), b2 = (1 - b1) * random.uniform<double>();
    const SurfaceInteraction<Real> si = point_of_triangle(half, static_cast<Real>(b1), static_cast<Real>(b2));
    const Vec3d normal = convert<double>(si.normal), w = random.on_sphere();
    const Vec3d along = normalize(w - normal * dot(w, normal));
    const Vec3d direction = along + normal * random.magnitude_between(1e-2, 1);
    const Ray<Real> ray = spawn_ray(si, normalize(convert<Real>(direction)));
    Real t, c1, c2;
    hit += intersect_triangle(shear_ray(ray, 1), p[0], p[2], p[3], infinity<Real>, t, c1, c2);
  }
  EXPECT_EQ(hit, 0u) << "of " << rays;
}

}  // namespace
}  // namespace alhazen::impl::test
