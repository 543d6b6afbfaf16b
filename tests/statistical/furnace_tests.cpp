// White furnace: in a closed surface of albedo a that emits radiance 1, paths of D segments give 1 + a + ... + a^(D-1).

#include <gtest/gtest.h>

#include "support/compiled_scenes.h"
#include "support/effort.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

constexpr double albedo = 0.8;
constexpr uint32_t depths[] = {1, 2, 5, 10};
constexpr size_t cases = 2 * 2 * 4 * 2 * std::size(depths);  // shapes, precisions, integrators, samplers, depths
constexpr uint32_t side = 16;

const std::string head = film_of(side, side) + R"(
    Camera "perspective" "float fov" 90
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
    AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true
)";

const std::string sphere = head + R"(
    Translate 0.3 -0.2 0.1
    Shape "sphere" "float radius" 2
)";

const std::string box = head + R"(
    Shape "trianglemesh"
      "point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 2  1 -1 2  1 1 2  -1 1 2]
      "integer indices" [0 1 2 0 2 3  4 6 5 4 7 6  0 4 5 0 5 1  3 2 6 3 6 7  0 3 7 0 7 4  1 5 6 1 6 2]
)";

double expected_radiance(uint32_t segments) { return (1 - std::pow(albedo, segments)) / (1 - albedo); }

template <class Real>
void check_furnace(const std::string& text) {
  const CompiledScene<Real> scene = compiled_scene_of<Real>(text);
  for (const IntegratorKind integrator : all_integrators)
    for (const SamplerType sampler : all_samplers)
      for (const uint32_t segments : depths) {
        const Take take{integrator, sampler, segments, static_cast<uint32_t>(effort(64)), 3};
        const Moments pixels = render_pixels(scene.view, take, side, side);
        const double expected = expected_radiance(segments);
        EXPECT_NEAR(pixels.mean(), expected, 0.025) << take.name();
        const double rounding = expected * by_precision<Real>(1e-6, 1e-12);
        EXPECT_GT(mean_p_value(pixels, expected, rounding), sidak(0.01, cases))
            << take.name() << ": " << pixels.mean() << " +- " << pixels.standard_error() << " instead of " << expected;
      }
}

template <class Real>
class Furnace : public ::testing::Test {};
TYPED_TEST_SUITE(Furnace, Reals);

TYPED_TEST(Furnace, Sphere) { check_furnace<TypeParam>(sphere); }
TYPED_TEST(Furnace, BoxOfTriangles) { check_furnace<TypeParam>(box); }

}  // namespace
}  // namespace alhazen::impl::test
