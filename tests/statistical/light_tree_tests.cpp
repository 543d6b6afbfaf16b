// The choice of one of many lights: its probabilities sum to 1, lights are chosen as often as they say, and no light
// that reaches a point is omitted.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/integrators/stages.h"
#include "support/chi_squared.h"
#include "support/effort.h"
#include "support/light_scenes.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
class LightTree : public ::testing::Test {};
TYPED_TEST_SUITE(LightTree, Reals);

/// Points inside, at the edge of and far outside the bounding box of the lights; every other with a surface normal.
template <class Real, class Check>
void for_points(int count, const Check& check) {
  Random random(23);
  for (int i = 0; i < count; ++i) {
    const Vec3<Real> point = convert<Real>(random.in_box(-2, 2) * random.magnitude_between(0.5, 30));
    check(point, i % 2 == 0 ? Vec3<Real>{} : convert<Real>(random.on_sphere()));
  }
}

template <class Real>
double pmf_of(const SceneView<Real>& scene, uint32_t light, const Vec3<Real>& point, const Vec3<Real>& normal) {
  return static_cast<double>(pmf_of_light_tree(scene, scene.lights[light].trail, point, normal));
}

/// The probability that the descent from `node` ends where neither child can contribute, so that none is chosen.
template <class Real>
double pmf_of_nothing(const SceneView<Real>& scene, const LightTreeNode& node, const Vec3<Real>& point,
                      const Vec3<Real>& normal) {
  if (node.is_leaf()) return 0;
  const Real p = first_child_probability(scene, node.index(), point, normal);
  if (p < 0) return 1;
  const double first = static_cast<double>(p), second = static_cast<double>(1 - p);
  const LightTreeNode* children = scene.light_tree + node.index();
  return (first > 0 ? first * pmf_of_nothing(scene, children[0], point, normal) : 0) +
         (second > 0 ? second * pmf_of_nothing(scene, children[1], point, normal) : 0);
}

const std::string sky = R"(LightSource "infinite" "rgb L" [ 0.1 0.1 0.1 ] LightSource "distant" "float scale" 0.1
)";

/// The probability that `choose_light` chooses this one.
template <class Real>
double pmf_of_choice(const SceneView<Real>& scene, uint32_t light, const Vec3<Real>& point, const Vec3<Real>& normal) {
  const auto by_tree = static_cast<double>(light_tree_probability(scene, point, normal));
  return scene.lights[light].kind == LightKind::distant ? (1 - by_tree) * static_cast<double>(scene.lights[light].pmf)
                                                        : by_tree * pmf_of(scene, light, point, normal);
}

TYPED_TEST(LightTree, ProbabilitiesSumToOne) {
  using Real = TypeParam;
  for (const int count : {3, 6, 100, 1000}) {
    const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin " + sky + small_lights(count, 3, true));
    ASSERT_EQ(scene.view.light_tree_count, 2 * static_cast<uint32_t>(count));
    ASSERT_EQ(scene.view.lights_count, static_cast<uint32_t>(count) + 1);
    for_points<Real>(20, [&](const Vec3<Real>& point, const Vec3<Real>& normal) {
      double sum = pmf_of_nothing(scene.view, scene.view.light_tree[0], point, normal);
      for (uint32_t i = 0; i < scene.view.lights_count; ++i) {
        if (scene.view.lights[i].kind != LightKind::distant) sum += pmf_of(scene.view, i, point, normal);
      }
      EXPECT_NEAR(sum, 1, by_precision<Real>(1e-4, 1e-12)) << count;
    });
  }
}

TYPED_TEST(LightTree, LightsComeUpAsOftenAsTheyShould) {
  using Real = TypeParam;
  const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin " + sky + small_lights(60, 4, true));
  const SceneView<Real>& view = scene.view;
  constexpr int points = 10;
  const auto samples = static_cast<int>(effort(200'000));
  for_points<Real>(points, [&](const Vec3<Real>& point, const Vec3<Real>& normal) {
    std::vector<double> observed(view.lights_count + 1), expected;
    Random random(9);
    for (int i = 0; i < samples; ++i) {
      const LightChoice<Real> choice = choose_light(view, point, normal, random.uniform<Real>());
      if (choice.light == no_light) {
        ++observed.back();
        continue;
      }
      const double pmf = pmf_of_choice(view, choice.light, point, normal);
      EXPECT_NEAR(static_cast<double>(choice.pmf), pmf, 1e-5 * pmf);
      ++observed[choice.light];
    }
    for (uint32_t i = 0; i < view.lights_count; ++i)
      expected.push_back(pmf_of_choice(view, i, point, normal) * samples);
    expected.push_back(static_cast<double>(light_tree_probability(view, point, normal)) * samples *
                       pmf_of_nothing(view, view.light_tree[0], point, normal));
    EXPECT_GT(chi_squared_test(observed, expected).p_value, sidak(0.01, 2 * points));
  });
}

/// Lights that illuminate the front of a surface have a positive probability.
TYPED_TEST(LightTree, NoLightThatMattersIsLeftOut) {
  using Real = TypeParam;
  const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin " + small_lights(200, 5, true));
  const SceneView<Real>& view = scene.view;
  Random random(6);
  int reaching = 0;
  for_points<Real>(100, [&](const Vec3<Real>& point, const Vec3<Real>& normal) {
    for (uint32_t i = 0; i < view.lights_count; ++i) {
      SceneView<Real> alone = view;
      alone.lights += i;
      alone.lights_count = 1;
      alone.light_tree_count = 0;
      const LightSample<Real> s = sample_light(alone, point, Vec3<Real>{}, Real(0), random.uniform_2d<Real>());
      const bool is_seen = is_zero(normal) || dot(normal, s.direction) > Real(1e-5);
      if (!(s.pdf > 0) || is_zero(s.radiance) || !is_seen) continue;
      ++reaching;
      EXPECT_GT(pmf_of(view, i, point, normal), 0) << i;
    }
  });
  EXPECT_GT(reaching, 1000);
}

/// All at one point, and each ten times as far away as the previous one: the deepest trees possible.
TYPED_TEST(LightTree, LightsThatNoPlaneParts) {
  using Real = TypeParam;
  std::string same, line;
  for (int i = 0; i < 300; ++i) {
    same += "LightSource \"point\" \"point3 from\" [ 1 2 3 ]\n";
    line += "LightSource \"point\" \"point3 from\" [ " + std::to_string(std::pow(1.12, i)) + " 0 0 ]\n";
  }
  for (const std::string& lights : {same, line}) {
    const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin " + lights);
    double sum = 0;
    for (uint32_t i = 0; i < 300; ++i) sum += pmf_of(scene.view, i, Vec3<Real>{}, Vec3<Real>{});
    EXPECT_NEAR(sum, 1, 1e-4);
  }
}

/// With few lights, they are chosen by power unless the scene requests the tree; with many, or with lights at infinity
/// that are sampled, by the tree unless it requests power.
TYPED_TEST(LightTree, IsBuiltWhereItIsOfUse) {
  using Real = TypeParam;
  const auto nodes = [](int count, const std::string& sampler, const std::string& others = "") {
    const std::string integrator =
        sampler.empty() ? "" : "Integrator \"path\" \"string lightsampler\" \"" + sampler + "\" ";
    return compiled_scene_of<Real>(integrator + "WorldBegin " + others + small_lights(count, 3, true))
        .view.light_tree_count;
  };
  EXPECT_EQ(nodes(2, ""), 0u);
  EXPECT_EQ(nodes(3, ""), 6u);
  EXPECT_EQ(nodes(1, "bvh"), 2u);
  EXPECT_EQ(nodes(50, "power"), 0u);
  EXPECT_EQ(nodes(2, "", "LightSource \"infinite\" "), 0u);
  EXPECT_EQ(nodes(2, "", sky), 4u);
  EXPECT_EQ(nodes(2, "power", sky), 0u);
}

/// A lamp that is black all over is never sampled, and the others get its probability; a half-black one counts half.
TYPED_TEST(LightTree, TexturesCountForThePower) {
  using Real = TypeParam;
  const std::string lamp =
      R"(Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  1 1 0  0 1 0] "integer indices" [0 1 2 0 2 3])";
  Scene scene = described_scene("WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " + lamp + lamp + lamp);
  for (uint32_t i = 0; i < 2; ++i) {
    Texture texture;
    texture.value = splat(i == 0 ? 0.0 : 0.5);
    scene.groups[0].shapes[i].emission->texture = static_cast<uint32_t>(scene.textures.size());
    scene.textures.push_back(texture);
  }
  const CompiledScene<Real> flat = compiled_scene<Real>(std::move(scene));
  const SceneView<Real>& view = flat.view;
  ASSERT_EQ(view.lights_count, 6u);
  const std::array<double, 3> expected{0.0, 1.0 / 6, 1.0 / 3};
  for (uint32_t i = 0; i < 6; ++i) EXPECT_NEAR(static_cast<double>(view.lights[i].pmf), expected[i / 2], 1e-6);
}

}  // namespace
}  // namespace alhazen::impl::test
