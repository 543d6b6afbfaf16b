// All integrators converge to the same image: every pair is compared, on every block of pixels, by Welch's test over
// images with different seeds. Three of them find light by BSDF sampling alone, the fourth samples lights.

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/compiled_scenes.h"
#include "support/effort.h"
#include "support/environments.h"
#include "support/light_scenes.h"
#include "support/reals.h"
#include "support/render_pixels.h"
#include "support/scenes.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t side = 24, block_side = 4, blocks_a_side = side / block_side;
constexpr size_t blocks = blocks_a_side * blocks_a_side;
constexpr size_t integrators = std::size(all_integrators);
constexpr size_t pairs = integrators * (integrators - 1) / 2;
/// Scenes, precisions, pairs; every block and the whole image.
constexpr size_t cases = 8 * 2 * pairs * (blocks + 1);

/// Moments of each block's mean over images with different seeds, and at the end of the whole image's.
using BlockMoments = std::array<Moments, blocks + 1>;

template <class Real>
void add_image(const SceneView<Real>& scene, const Take& take, BlockMoments& moments) {
  std::array<double, blocks + 1> means{};
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const double value = luminance(render_pixel(scene, take, x, y));
      means[y / block_side * blocks_a_side + x / block_side] += value / (block_side * block_side);
      means[blocks] += value / (side * side);
    }
  for (size_t i = 0; i < means.size(); ++i) moments[i].add(means[i]);
}

template <class Real>
void check_agreement(const CompiledScene<Real>& scene, SamplerType sampler) {
  std::array<BlockMoments, integrators> moments;
  for (size_t i = 0; i < integrators; ++i)
    for (uint32_t run = 0; run < effort(32); ++run) {
      // Each integrator has seeds of its own: the same random numbers would give the same paths.
      const uint32_t seed = static_cast<uint32_t>(1000 * i) + run;
      add_image(scene.view, Take{all_integrators[i], sampler, 6, 8, seed}, moments[i]);
    }
  EXPECT_GT(moments[0][blocks].mean(), 0.1) << "the scene is dark";
  for (size_t i = 0; i < integrators; ++i)
    for (size_t j = i + 1; j < integrators; ++j)
      for (size_t block = 0; block <= blocks; ++block)
        EXPECT_GT(welch_p_value(moments[i][block], moments[j][block], 1e-6), sidak(0.01, cases))
            << to_string(all_integrators[i]) << " " << moments[i][block].mean() << " +- "
            << moments[i][block].standard_error() << ", " << to_string(all_integrators[j]) << " "
            << moments[j][block].mean() << " +- " << moments[j][block].standard_error() << ", block " << block;
}

template <class Real>
void check_agreement(const std::string& text, SamplerType sampler) {
  check_agreement(compiled_scene_of<Real>(film_of(side, side) + text), sampler);
}

template <class Real>
class IntegratorsAgree : public ::testing::Test {};
TYPED_TEST_SUITE(IntegratorsAgree, Reals);

TYPED_TEST(IntegratorsAgree, CornellBoxSobol) { check_agreement<TypeParam>(cornell_box, SamplerType::sobol); }
TYPED_TEST(IntegratorsAgree, CornellBoxIndependent) {
  check_agreement<TypeParam>(cornell_box, SamplerType::independent);
}
TYPED_TEST(IntegratorsAgree, GlassSobol) { check_agreement<TypeParam>(furnace_of_glass, SamplerType::sobol); }
TYPED_TEST(IntegratorsAgree, GlassIndependent) {
  check_agreement<TypeParam>(furnace_of_glass, SamplerType::independent);
}

/// Textured lights, chosen by power (two of them) and by the tree.
TYPED_TEST(IntegratorsAgree, TexturedLamp) {
  check_agreement(compiled_scene<TypeParam>(with_emission_texture(described_scene(film_of(side, side) + cornell_box))),
                  SamplerType::sobol);
}
TYPED_TEST(IntegratorsAgree, ManyTexturedLights) {
  const CompiledScene<TypeParam> scene = compiled_scene<TypeParam>(
      with_emission_texture(described_scene(film_of(side, side) + room_of_lights(40, false, 1.2))));
  ASSERT_GT(scene.view.light_tree_count, 0u);
  check_agreement(scene, SamplerType::independent);
}

/// A lamp among surfaces that reflect, transmit, and let some rays pass, all of which a light at infinity reaches too.
const std::string lamp_in_the_open = film_of(side, side) + R"(
    LookAt 0 -5 2.5  0 0 0.4  0 0 1
    Camera "perspective" "float fov" 40
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
    Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2 0 2 3]
    AttributeBegin
      AreaLightSource "diffuse" "rgb L" [3 3 3] "bool twosided" true
      Shape "trianglemesh" "point3 P" [-1 1 0  1 1 0  1 1.5 1.5  -1 1.5 1.5] "integer indices" [0 1 2 0 2 3]
    AttributeEnd
    Shape "trianglemesh" "point3 P" [-1.5 -1 0  -0.5 -1 0  -0.5 -1 1  -1.5 -1 1] "integer indices" [0 1 2 0 2 3]
      "float alpha" 0.5
    Material "diffusetransmission"
    Shape "trianglemesh" "point3 P" [0.3 -1 0  1.5 -1 0  1.5 -1 1  0.3 -1 1] "integer indices" [0 1 2 0 2 3]
    Material "conductor" "rgb reflectance" [0.9 0.9 0.9] "float roughness" 0.2
    AttributeBegin Translate 0 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
)";

TYPED_TEST(IntegratorsAgree, LampAndASun) {
  const CompiledScene<TypeParam> scene = compiled_scene_of<TypeParam>(
      lamp_in_the_open + "LightSource \"distant\" \"point3 from\" [1 -2 2] \"float angle\" 40 \"float scale\" 0.5");
  ASSERT_GT(scene.view.light_tree_count, 0u);
  ASSERT_GT(scene.view.infinite_irradiance, TypeParam(0));
  check_agreement(scene, SamplerType::independent);
}
TYPED_TEST(IntegratorsAgree, LampAndAMap) {
  const CompiledScene<TypeParam> scene =
      compiled_scene<TypeParam>(lit_by(described_scene(lamp_in_the_open), sun_map(16, 8, 20), map_askew()));
  ASSERT_GT(scene.view.infinite_irradiance, TypeParam(0));
  check_agreement(scene, SamplerType::sobol);
}

}  // namespace
}  // namespace alhazen::impl::test
