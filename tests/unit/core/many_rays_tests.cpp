// Rays that are traced in batches have bitwise the same hits as single rays, interleaved or in packets, with every
// instruction set. These hits are those of a linear scan.

#include <gtest/gtest.h>

#include "core/bvh/brute_force/intersector.h"
#include "isa/queries.h"
#include "support/closed_meshes.h"
#include "support/effort.h"
#include "support/instanced_scenes.h"
#include "support/primitive_scenes.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
struct Queries {
  std::vector<Ray<Real>> rays;
  std::vector<Real> limits;

  void add(const Vec3d& origin, const Vec3d& direction, double time, double limit) {
    rays.push_back({convert<Real>(origin), normalize(convert<Real>(direction)), static_cast<Real>(time)});
    limits.push_back(static_cast<Real>(limit));
  }
};

template <class Real>
struct Answers {
  std::vector<Hit<Real>> hits;
  std::unique_ptr<bool[]> found;

  Answers(const SceneView<Real>& scene, InstructionSet set, QueryMode mode, bool any_hit, const Queries<Real>& queries)
      : hits(queries.rays.size()), found(new bool[queries.rays.size()]()) {
    answer_queries(scene, set, mode, any_hit, static_cast<uint32_t>(hits.size()), queries.rays.data(),
                   queries.limits.data(), hits.data(), found.get());
  }
};

/// Bundles of 1 to 40 rays from about one point in about one direction, with and without limits: some as narrow as a
/// pixel, some so wide that they diverge.
template <class Real>
Queries<Real> bundles(Random& random, size_t rays, double size) {
  Queries<Real> queries;
  while (queries.rays.size() < rays) {
    const Vec3d origin = random.in_box(-size, size);
    const Vec3d towards = random.in_box(-0.5, 0.5) * size - origin;
    const double spread = size * random.magnitude_between(1e-4, 1);
    for (uint32_t i = 1 + random.below(40); i > 0; --i)
      queries.add(origin + random.in_box(-1e-3, 1e-3), normalize(towards + random.in_box(-1, 1) * spread),
                  random.uniform<double>(),
                  random.uniform<double>() < 0.2 ? random.magnitude_between(0.1, 2 * size) : infinity<double>);
  }
  return queries;
}

/// Rays along axes, and with NaN and infinity: batches give the result of single rays, whatever it is.
template <class Real>
void add_odd_rays(Queries<Real>& queries) {
  for (const double x : {0.0, -0.0, 1.0, 1e30, infinity<double>, std::numeric_limits<double>::quiet_NaN()})
    for (const Vec3d& direction : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, -0.0, 1}}) {
      queries.rays.push_back({convert<Real>(Vec3d{x, 0.25, -2}), convert<Real>(direction), Real(0.5)});
      queries.limits.push_back(infinity<Real>);
    }
}

template <class Real>
void expect_same(const Hit<Real>& a, const Hit<Real>& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.b1, b.b1);
  EXPECT_EQ(a.b2, b.b2);
  EXPECT_TRUE(a.primitive == b.primitive);
  EXPECT_EQ(a.instance, b.instance);
}

template <class Real>
void check(const SceneView<Real>& scene, const Queries<Real>& queries) {
  const BruteForceIntersector<Real> linear(scene);
  const Answers<Real> alone(scene, InstructionSet::baseline, QueryMode::single, false, queries);
  size_t hit_count = 0;
  for (size_t i = 0; i < queries.rays.size(); ++i) {
    Hit<Real> expected;
    EXPECT_EQ(alone.found[i], linear.closest_hit(queries.rays[i], queries.limits[i], expected));
    if (alone.found[i]) expect_same(alone.hits[i], expected);
    hit_count += alone.found[i];
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(hit_count, queries.rays.size() / 10);
  for (const InstructionSet set : instruction_sets())
    for (const QueryMode mode : query_modes)
      for (const bool any_hit : {false, true}) {
        if (any_hit && mode == QueryMode::coherent) continue;
        const Answers<Real> answers(scene, set, mode, any_hit, queries);
        for (size_t i = 0; i < queries.rays.size(); ++i) {
          EXPECT_EQ(answers.found[i], alone.found[i]);
          if (answers.found[i] && !any_hit) expect_same(answers.hits[i], alone.hits[i]);
        }
        if (::testing::Test::HasFailure()) {
          ADD_FAILURE() << to_string(set) << ", mode " << static_cast<int>(mode) << (any_hit ? ", any hit" : "");
          return;
        }
      }
}

template <class Real>
class ManyRays : public ::testing::Test {};
TYPED_TEST_SUITE(ManyRays, Reals);

TYPED_TEST(ManyRays, MixedPrimitives) {
  const CompiledScene<TypeParam> scene = mixed_primitives(7, 200).flat<TypeParam>();
  Random random(21);
  Queries<TypeParam> queries = bundles<TypeParam>(random, effort(20'000), 15);
  add_odd_rays(queries);
  check(scene.view, queries);
}

TYPED_TEST(ManyRays, BruteForcePackets) {
  Random random(26);
  for (const int count : {1, 3, 8, 14, 25}) {
    PrimitiveScene primitives;
    for (int i = 0; i < count; ++i) {
      const Vec3d p = random.in_box(-3, 3);
      primitives.add_triangle(p, p + random.on_sphere() * 4, p + random.on_sphere() * 4);
      primitives.add_sphere(random.in_box(-3, 3), 1);
      primitives.add_sphere(random.in_box(-3, 3), 1, random.in_box(-2, 2));
      primitives.add_cylinder(random_cylinder(random.in_box(-3, 3), 1, random), i % 2 == 0 ? 360 : 200);
      primitives.add_disk(random_cylinder(random.in_box(-3, 3), 1, random), i % 3 == 0 ? 0.4 : 0,
                          i % 2 == 0 ? 360 : 200);
    }
    const CompiledScene<TypeParam> scene = primitives.flat<TypeParam>();
    Queries<TypeParam> queries = bundles<TypeParam>(random, effort(5'000), 5);
    add_odd_rays(queries);
    check(scene.view, queries);
  }
}

/// Triangles that share no vertices: the maximum for brute force with some instruction set, and one more.
TYPED_TEST(ManyRays, FewVertices) {
  Random random(29);
  for (const int count : {4, 5, 9, 10, 18, 19, 37, 38}) {
    PrimitiveScene primitives;
    for (int i = 0; i < count; ++i) {
      const Vec3d p = random.in_box(-3, 3);
      primitives.add_triangle(p, p + random.on_sphere() * 6, p + random.on_sphere() * 6);
    }
    const CompiledScene<TypeParam> scene = primitives.flat<TypeParam>();
    Queries<TypeParam> queries = bundles<TypeParam>(random, effort(5'000), 5);
    add_odd_rays(queries);
    check(scene.view, queries);
  }
}

TYPED_TEST(ManyRays, EdgesOfASmallMesh) {
  Random random(28);
  const Mesh mesh = icosphere(0);
  PrimitiveScene primitives;
  primitives.add_mesh(mesh);
  const CompiledScene<TypeParam> scene = primitives.flat<TypeParam>();
  // From the centre and from outside towards vertices and points on edges, where triangles have equal distances.
  Queries<TypeParam> queries;
  while (queries.rays.size() < effort(5'000)) {
    const Vec3d& corner = mesh.positions[random.below(static_cast<uint32_t>(mesh.positions.size()))];
    const Vec3d& other = mesh.positions[random.below(static_cast<uint32_t>(mesh.positions.size()))];
    const double weight = random.below(3) * 0.5;
    const Vec3d origin = random.below(2) ? Vec3d{} : random.in_box(-4, 4);
    const Vec3d to_target = corner * weight + other * (1 - weight) - origin;
    if (length(to_target) > 0.1) queries.add(origin, normalize(to_target), 0, infinity<double>);
  }
  check(scene.view, queries);
}

TYPED_TEST(ManyRays, MeshFarAway) {
  Random random(22);
  Mesh mesh = icosphere(3);
  jitter_radii(mesh, 0.05, random);
  const Vec3d centre{1.5e5, -1.5e5, 1.5e5};
  for (Vec3d& p : mesh.positions) p = p * 100 + centre;
  PrimitiveScene primitives;
  primitives.add_mesh(mesh);
  const CompiledScene<TypeParam> scene = primitives.flat<TypeParam>();
  Queries<TypeParam> queries = bundles<TypeParam>(random, effort(5'000), 300);
  for (Ray<TypeParam>& ray : queries.rays) ray.origin += convert<TypeParam>(centre);
  check(scene.view, queries);
}

TYPED_TEST(ManyRays, Instances) {
  const CompiledScene<TypeParam> scene = flat_instanced_scene<TypeParam>(instanced_scene(24, 100, 10), false);
  Random random(25);
  Queries<TypeParam> queries = bundles<TypeParam>(random, effort(10'000), 15);
  add_odd_rays(queries);
  check(scene.view, queries);
}

TYPED_TEST(ManyRays, InAnEmptyScene) {
  const CompiledScene<TypeParam> scene = PrimitiveScene().flat<TypeParam>();
  Random random(23);
  const Queries<TypeParam> queries = bundles<TypeParam>(random, 100, 10);
  for (const InstructionSet set : instruction_sets())
    for (const QueryMode mode : query_modes) {
      const Answers<TypeParam> answers(scene.view, set, mode, false, queries);
      for (size_t i = 0; i < queries.rays.size(); ++i) EXPECT_FALSE(answers.found[i]);
    }
}

}  // namespace
}  // namespace alhazen::impl::test
