// The contract of core/bvh/ray_intersector.h, for every intersector that a CPU can run.

#include <gtest/gtest.h>

#include <limits>

#include "core/bvh/brute_force/intersector.h"
#include "support/engines.h"
#include "support/instanced_scenes.h"
#include "support/primitive_scenes.h"
#if defined(ALHAZEN_WITH_EMBREE)
#include "backends/embree/module/intersector.h"
#include "backends/embree/module/scene.h"
#endif

namespace alhazen::impl::test {
namespace {

template <class Engine>
struct OverScene {
  using Real = typename Engine::Real;
  static constexpr bool breaks_ties = true;

  explicit OverScene(const SceneView<Real>& scene) : intersector(scene) {}

  typename Engine::Intersector intersector;
};

template <class Any>
struct BruteForceEngine {
  using Real = Any;
  using Intersector = BruteForceIntersector<Any>;
};

#if defined(ALHAZEN_WITH_EMBREE)
struct OverEmbree {
  using Real = float;
  static constexpr bool breaks_ties = false;

  explicit OverEmbree(const SceneView<float>& view) : scene(view, 1), intersector(view, scene.tracer()) {}

  EmbreeScene scene;
  EmbreeIntersector intersector;
};
#endif

using Intersectors = ::testing::Types<
#if defined(ALHAZEN_WITH_EMBREE)
    OverEmbree,
#endif
    OverScene<BruteForceEngine<float>>, OverScene<BruteForceEngine<double>>, OverScene<Bvh2Engine<float>>,
    OverScene<Bvh2Engine<double>>, OverScene<CwbvhEngine>, OverScene<Bvh8Engine<float>>, OverScene<Bvh8Engine<double>>,
    OverScene<IsaEngine<float, InstructionSet::avx2>>, OverScene<IsaEngine<double, InstructionSet::avx512>>>;

template <class Over>
class RayIntersectors : public ::testing::Test {
 public:
  using RealOf = typename Over::Real;

  static Ray<RealOf> ray_along_z(RealOf x) { return {{x, 0, 0}, {0, 0, 1}}; }

  /// Returns whether the ray hits anything. closest_hit and occluded must agree.
  static bool hits(const Over& over, const Ray<RealOf>& ray, RealOf t_max, Hit<RealOf>* hit = nullptr) {
    Hit<RealOf> found;
    const bool is_hit = over.intersector.closest_hit(ray, t_max, found);
    EXPECT_EQ(over.intersector.occluded(ray, t_max), is_hit) << "t_max " << t_max;
    if (hit) *hit = found;
    return is_hit;
  }

  /// A triangle across the z axis at z = 5, and a sphere about x = 10, a cylinder about x = 20 and a disk about x = 30
  /// that begin there.
  static CompiledScene<RealOf> one_of_each() {
    PrimitiveScene scene;
    scene.add_triangle({-1, -1, 5}, {1, -1, 5}, {0, 1, 5});
    scene.add_sphere({10, 0, 6}, 1);
    scene.add_cylinder(Transform::translate({20, 0, 6}) * Transform::rotate(90, {1, 0, 0}));
    scene.add_disk(Transform::translate({30, 0, 5}));
    return scene.flat<RealOf>();
  }
  static constexpr RealOf middles[] = {0, 10, 20, 30};
};
TYPED_TEST_SUITE(RayIntersectors, Intersectors);

/// The least limit that must let a hit at `t` pass. Embree's last bits depend on the instruction set.
template <class Over, class Real>
Real just_beyond(Real t) {
  return std::is_same_v<Over, OverEmbree> ? t + Real(1e-5) : std::nextafter(t, Real(6));
}

TYPED_TEST(RayIntersectors, IntervalIsOpen) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = this->one_of_each();
  const TypeParam over(scene.view);
  for (const Real x : this->middles) {
    const Ray<Real> ray = this->ray_along_z(x);
    Hit<Real> hit;
    ASSERT_TRUE(this->hits(over, ray, infinity<Real>, &hit)) << x;
    EXPECT_NEAR(hit.t, Real(5), Real(2e-6));
    EXPECT_FALSE(this->hits(over, ray, hit.t)) << x;
    EXPECT_TRUE(this->hits(over, ray, just_beyond<TypeParam>(hit.t))) << x;
    for (const Real t_max : {Real(0), -Real(0), Real(-1), -infinity<Real>, std::numeric_limits<Real>::quiet_NaN()})
      EXPECT_FALSE(this->hits(over, ray, t_max)) << x;
    Ray<Real> from_the_surface = ray;
    from_the_surface.origin.z = 5;
    EXPECT_EQ(this->hits(over, from_the_surface, Real(1)), false) << x;
  }
}

/// The same if the first triangle belongs to an object.
TYPED_TEST(RayIntersectors, IntervalIsOpenInInstances) {
  using Real = typename TypeParam::Real;
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}};
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  scene.groups.resize(2);
  Shape shape;
  shape.mesh = 0;
  scene.groups[1].shapes.push_back(shape);
  for (int i = 0; i < 2; ++i) {
    Instance instance;
    instance.group = 1;
    const Transform placement = Transform::translate({8.0 * i, 0, 0});
    instance.world_from_group = {placement, placement};
    scene.instances.push_back(instance);
  }
  const CompiledScene<Real> flat = flat_instanced_scene<Real>(scene, false);
  ASSERT_EQ(flat.view.instances_count, 2u);
  const TypeParam over(flat.view);
  for (uint32_t i = 0; i < 2; ++i) {
    const Ray<Real> ray = this->ray_along_z(static_cast<Real>(8 * i));
    Hit<Real> hit;
    ASSERT_TRUE(this->hits(over, ray, infinity<Real>, &hit));
    EXPECT_NEAR(hit.t, Real(5), Real(2e-6));
    EXPECT_EQ(hit.instance, i);
    EXPECT_FALSE(this->hits(over, ray, hit.t)) << "instance " << i;
    EXPECT_TRUE(this->hits(over, ray, just_beyond<TypeParam>(hit.t))) << "instance " << i;
  }
}

/// Of two coincident triangles, the one with the lower PrimitiveId is hit, unless the ray starts on it.
TYPED_TEST(RayIntersectors, TiesGoToTheLowestPrimitive) {
  using Real = typename TypeParam::Real;
  PrimitiveScene primitives;
  for (int i = 0; i < 2; ++i) primitives.add_triangle({-1, -1, 5}, {1, -1, 5}, {0, 1, 5});
  const CompiledScene<Real> scene = primitives.flat<Real>();
  const TypeParam over(scene.view);
  Ray<Real> ray = this->ray_along_z(0);
  Hit<Real> hit;
  ASSERT_TRUE(this->hits(over, ray, infinity<Real>, &hit));
  if (TypeParam::breaks_ties) {
    EXPECT_EQ(hit.primitive, PrimitiveId(PrimitiveKind::triangle, 0));
  }
  for (uint32_t left = 0; left < 2; ++left) {
    ray.left = PrimitiveId(PrimitiveKind::triangle, left);
    ASSERT_TRUE(this->hits(over, ray, infinity<Real>, &hit));
    EXPECT_EQ(hit.primitive, PrimitiveId(PrimitiveKind::triangle, 1 - left));
  }
}

TYPED_TEST(RayIntersectors, RaysThatAreNotFiniteHitNothing) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = this->one_of_each();
  const TypeParam over(scene.view);
  for (const Real x : this->middles)
    for (const Real odd : {infinity<Real>, -infinity<Real>, std::numeric_limits<Real>::quiet_NaN()})
      for (int place = 0; place < 6; ++place) {
        Ray<Real> ray = this->ray_along_z(x);
        (place < 3 ? ray.origin : ray.direction)[place % 3] = odd;
        EXPECT_FALSE(this->hits(over, ray, infinity<Real>)) << odd << " in place " << place << " of " << x;
      }
}

TYPED_TEST(RayIntersectors, DirectionsMayHaveZerosOfEitherSign) {
  using Real = typename TypeParam::Real;
  const CompiledScene<Real> scene = this->one_of_each();
  const TypeParam over(scene.view);
  for (const Real x : this->middles)
    for (int signs = 0; signs < 4; ++signs) {
      Ray<Real> ray = this->ray_along_z(x);
      ray.direction.x = signs & 1 ? -Real(0) : Real(0);
      ray.direction.y = signs & 2 ? -Real(0) : Real(0);
      EXPECT_TRUE(this->hits(over, ray, infinity<Real>)) << x << " with signs " << signs;
    }
}

}  // namespace
}  // namespace alhazen::impl::test
