// Values in a file that the precision of the render cannot represent: in float they are refused, or omitted with a
// warning; in double they are rendered.

#include "core/textures/image.h"
#include "core/textures/noise.h"
#include "support/compiled_scenes.h"

namespace alhazen::impl::test {
namespace {

struct Compiled {
  std::string error;     ///< empty if there was none
  std::string warnings;  ///< of the scene compiler, joined
  size_t spheres = 0;
};

template <class Real>
Compiled compiled(const std::string& text) {
  Diagnostics diagnostics;
  Compiled result;
  try {
    const CompiledScene<Real> flat = compile_scene<Real>(described_scene(text), {}, diagnostics);
    result.spheres = flat.statistics.spheres;
  } catch (const InputError& error) {
    result.error = error.what();
  }
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) result.warnings += warning.to_string();
  return result;
}

/// Refused in float at its location in the file, and rendered in double.
void expect_for_double_alone(const std::string& text, const std::string& message) {
  SCOPED_TRACE(text);
  const std::string error = compiled<float>(text).error;
  EXPECT_NE(error.find(message), std::string::npos) << error;
  EXPECT_EQ(error.find("test.pbrt"), 0u) << error;
  EXPECT_EQ(compiled<double>(text).error, "");
}

TEST(PrecisionRange, LightsAreNotInfinite) {
  expect_for_double_alone("WorldBegin\nLightSource \"point\" \"rgb I\" [ 1e38 1e38 1e38 ] \"float scale\" 1e6\n",
                          "too bright or too far away");
  expect_for_double_alone("WorldBegin\nTranslate 1e30 0 0 Scale 1e20 1 1 Translate 1e20 0 0\nLightSource \"point\"\n",
                          "too bright or too far away");
  expect_for_double_alone("WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1e38 1e38 1e38 ] \"float scale\" 1e6\n",
                          "too bright");
  expect_for_double_alone(
      "WorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 1e38 1e38 1e38 ] \"float scale\" 1e6\nShape \"sphere\"\n",
      "radiance of the light is not finite");
}

TEST(PrecisionRange, CamerasAreFinite) {
  expect_for_double_alone(
      "Scale 1e-20 1e-20 1e-20 Translate 1e30 0 0\nCamera \"perspective\" \"float focaldistance\" 1e39\n"
      "WorldBegin LightSource \"infinite\"\nShape \"sphere\"\n",
      "the camera is not finite");
}

TEST(PrecisionRange, SpheresAreFinite) {
  expect_for_double_alone("WorldBegin LightSource \"infinite\"\nShape \"sphere\" \"float radius\" 1e20\n",
                          "the sphere is too large or too far away");
  // Two shapes, since a scene that is far away as a whole is moved (compile/render_space.h).
  expect_for_double_alone(
      "WorldBegin LightSource \"infinite\"\nShape \"sphere\"\n"
      "Scale 1e20 1e20 1e20 Translate 1e20 0 0\nShape \"sphere\" \"float radius\" 1e-20\n",
      "the sphere is too large or too far away");
}

TEST(PrecisionRange, SpheresThatAreTooSmallAreLeftOut) {
  const std::string text =
      "WorldBegin LightSource \"infinite\"\nShape \"sphere\"\nShape \"sphere\" \"float radius\" 1e-25\n";
  const Compiled single = compiled<float>(text), doubled = compiled<double>(text);
  EXPECT_EQ(single.error, "");
  EXPECT_EQ(single.spheres, 1u);
  EXPECT_NE(single.warnings.find("test.pbrt:3:1: a sphere is too small"), std::string::npos) << single.warnings;
  EXPECT_EQ(doubled.spheres, 2u);
  EXPECT_EQ(doubled.warnings, "");
}

TEST(PrecisionRange, NoiseIsFiniteEverywhere) {
  uint8_t permutation[256];
  for (int i = 0; i < 256; ++i) permutation[i] = static_cast<uint8_t>(i * 37);
  for (const float far : {1e6f, 1e15f, 3e38f, -3e38f, infinity<float>, std::numeric_limits<float>::quiet_NaN()})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f p{0.25f, -3.5f, 7.75f};
      p[axis] = far;
      EXPECT_LE(std::abs(perlin_noise(permutation, p)), 2) << far;
      EXPECT_LE(std::abs(octave_noise(permutation, p, 0.5f, 64, true)), 4) << far;
    }
}

TEST(PrecisionRange, MirroredImagesMayHaveTheMostTexels) {
  constexpr int most = 1 << 30;
  const auto mirror = static_cast<uint32_t>(WrapMode::mirror);
  EXPECT_EQ(wrapped_texel(most, most, mirror), most - 1);
  EXPECT_EQ(wrapped_texel(-1, most, mirror), 0);
  EXPECT_EQ(wrapped_texel(2'000'000'000, most, mirror), 147'483'647);   // 2^31 - 1 - 2 * 10^9
  EXPECT_EQ(wrapped_texel(-2'000'000'000, most, mirror), 147'483'648);  // 2^31 - 2 * 10^9
}

}  // namespace
}  // namespace alhazen::impl::test
