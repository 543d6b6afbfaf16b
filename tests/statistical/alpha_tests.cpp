// Transparent surfaces: the light that they transmit, and the agreement of light sampling and BSDF sampling.

#include <gtest/gtest.h>

#include "support/compiled_scenes.h"
#include "support/effort.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t side = 12;

const std::string camera =
    film_of(side, side) + "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30\n";
const std::string quad =
    " Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] \"integer indices\" "
    "[ 0 1 2 0 2 3 ] ";
const std::string black = " Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] ";

template <class Real>
class Alpha : public ::testing::Test {};
TYPED_TEST_SUITE(Alpha, Reals);

template <class Real>
void expect_mean(const CompiledScene<Real>& scene, double expected, double tolerance, uint32_t segments = 4) {
  for (const IntegratorKind integrator : all_integrators) {
    const Take take{integrator, SamplerType::sobol, segments, static_cast<uint32_t>(effort(64)), 5};
    EXPECT_NEAR(render_pixels(scene.view, take, side, side).mean(), expected, widened(tolerance)) << take.name();
  }
}

/// A black card of alpha 0.5 in front of a light, two of them, and one in which a checkerboard cuts holes.
TYPED_TEST(Alpha, CardsBeforeALight) {
  const std::string light =
      camera + "WorldBegin" + black +
      "AttributeBegin Translate 0 0 1 Scale 9 9 1 AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] "
      "\"bool twosided\" true" +
      quad + "AttributeEnd" + black;
  expect_mean(compiled_scene_of<TypeParam>(light + quad + "\"float alpha\" 0.5"), 0.5, 0.02);
  expect_mean(compiled_scene_of<TypeParam>(light + quad + "\"float alpha\" 0.5 Translate 0 0 0.2" + quad +
                                           "\"float alpha\" 0.5"),
              0.25, 0.02, 1);
  expect_mean(compiled_scene_of<TypeParam>(light +
                                           "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 24 "
                                           "\"float vscale\" 24 \"float tex1\" 0 \"float tex2\" 1" +
                                           quad + "\"texture alpha\" \"holes\""),
              0.5, 0.05, 1);
}

/// A floor lit by a lamp through a card: by light sampling, through two surfaces, and by BSDF sampling.
TYPED_TEST(Alpha, IntegratorsAgreeBehindACard) {
  const std::string text =
      film_of(side, side) + "LookAt 0 -4 2  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 30\n" +
      "WorldBegin Material \"diffuse\" \"rgb reflectance\" [ 0.8 0.8 0.8 ]\nAttributeBegin Scale 4 4 1" + quad +
      "AttributeEnd\nAttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [ 3 3 3 ] \"bool twosided\" "
      "true" +
      quad + "AttributeEnd\nAttributeBegin Translate 0 0 1 " + quad + "\"float alpha\" 0.4 AttributeEnd\n" +
      "AttributeBegin Translate 0.2 0 1.3 " + quad + "\"float alpha\" 0.7 AttributeEnd";
  const CompiledScene<TypeParam> scene = compiled_scene_of<TypeParam>(text);
  Moments by[2];
  constexpr uint32_t runs = is_sanitized ? 6 : 24;
  for (uint32_t run = 0; run < runs; ++run)
    for (int i = 0; i < 2; ++i) {
      const IntegratorKind integrator = i == 0 ? IntegratorKind::path : IntegratorKind::iterative;
      const Take take{integrator, SamplerType::independent, 4, 64, 1000u * static_cast<uint32_t>(i) + run};
      by[i].add(render_pixels(scene.view, take, side, side).mean());
    }
  EXPECT_GT(by[0].mean(), 0.05);
  EXPECT_GT(welch_p_value(by[0], by[1], 1e-6), 0.001)
      << by[0].mean() << " +- " << by[0].standard_error() << ", " << by[1].mean() << " +- " << by[1].standard_error();
}

/// One-sided surfaces are absent from behind.
TYPED_TEST(Alpha, OneSidedOnesAreSeenFromTheFront) {
  for (const bool from_behind : {false, true}) {
    Scene scene = described_scene(camera + "WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]" + black +
                                  (from_behind ? "ReverseOrientation " : "") + "Scale 5 5 1 " + quad);
    for (Material& material : scene.materials) material.double_sided = false;
    const CompiledScene<TypeParam> flat = compiled_scene<TypeParam>(std::move(scene));
    const Take take{IntegratorKind::path, SamplerType::sobol, 4, 4, 5};
    const double mean = render_pixels(flat.view, take, side, side).mean();
    EXPECT_TRUE(std::abs(mean) < 1e-6 || std::abs(mean - 1) < 1e-6) << mean;
    static double other = -1;
    if (from_behind) {
      EXPECT_NEAR(mean + other, 1, 1e-6);
    }
    other = mean;
  }
}

/// Beer-Lambert: a slab of thickness 2 with the index of its surroundings.
TYPED_TEST(Alpha, AbsorptionFollowsTheDistance) {
  Scene scene = described_scene(camera +
                                "WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]"
                                "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" "
                                "[ 0.3 0.3 0.3 ] \"rgb sigma_s\" [ 0 0 0 ] MediumInterface \"m\" \"\"\n"
                                "Material \"dielectric\" \"float eta\" 1.0000001 Scale 50 50 1 "
                                "Translate 0 0 1 Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  "
                                "-1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1] \"integer indices\" [0 2 1 0 3 2  "
                                "4 5 6 4 6 7  0 5 4 0 1 5  3 6 2 3 7 6  0 7 3 0 4 7  1 2 6 1 6 5]");
  const CompiledScene<TypeParam> flat = compiled_scene<TypeParam>(std::move(scene));
  expect_mean(flat, std::exp(-0.6), 0.02, 4);
}

}  // namespace
}  // namespace alhazen::impl::test
