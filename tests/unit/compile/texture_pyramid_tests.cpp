// Image pyramids preserve means, are sharp under magnification and grey from afar, and respect the texture budget.

#include <gtest/gtest.h>

#include <set>

#include "compile/images.h"
#include "core/cameras/camera.h"
#include "core/textures/texture.h"
#include "support/compiled_scenes.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

ImageTexels checks(int width, int height, bool as_floats) {
  ImageTexels image;
  image.width = width;
  image.height = height;
  image.srgb = false;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const bool white = ((x + y) & 1) != 0;
        if (as_floats)
          image.floats.push_back(white ? 1.0f : 0.0f);
        else
          image.bytes.push_back(white ? 255 : 0);
      }
  return image;
}

double mean_of(const ImageTexels& image) {
  double sum = 0;
  for (const float value : image.floats) sum += static_cast<double>(value);
  for (const uint8_t value : image.bytes) sum += value / 255.0;
  return sum / static_cast<double>(image.floats.size() + image.bytes.size());
}

TEST(Pyramid, MeansAreKeptWhateverTheSize) {
  for (const auto& [width, height] : {std::pair{8, 8}, {7, 5}, {1, 9}, {13, 1}, {3, 2}}) {
    ImageTexels image = checks(width, height, true);
    for (size_t i = 0; i < image.floats.size(); ++i) image.floats[i] += static_cast<float>(i % 7);
    const double mean = mean_of(image);
    while (image.width > 1 || image.height > 1) {
      const int w = image.width, h = image.height;
      image = halved(image);
      EXPECT_EQ(image.width, std::max(w / 2, 1));
      EXPECT_EQ(image.height, std::max(h / 2, 1));
      EXPECT_NEAR(mean_of(image), mean, 1e-5 * mean) << width << " x " << height;
    }
  }
}

TEST(Pyramid, BytesAreAveragedAsLight) {
  ImageTexels image = checks(2, 2, false);
  image.srgb = true;
  const ImageTexels half = halved(image);
  ASSERT_EQ(half.bytes.size(), 3u);
  EXPECT_EQ(half.bytes[0], 188) << "half of the light of white, sRGB-encoded";
  image.srgb = false;
  EXPECT_EQ(halved(image).bytes[0], 128);
}

TEST(Pyramid, OneChannelStaysOne) {
  ImageTexels image;
  image.width = 4;
  image.height = 2;
  image.channels = 1;
  image.floats = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(halved(image).floats, (std::vector<float>{2.5f, 4.5f}));
}

TEST(Pyramid, BudgetHalvesTheLargestAndWarnsOnce) {
  Scene scene;
  scene.images = {checks(64, 64, false), checks(16, 16, false), checks(64, 64, true)};
  Diagnostics diagnostics;
  fit_images(scene, 0, diagnostics);
  fit_images(scene, uint64_t{1} << 30, diagnostics);
  EXPECT_TRUE(diagnostics.warnings().empty());
  EXPECT_EQ(scene.images[2].width, 64);
  fit_images(scene, 40'000, diagnostics);
  EXPECT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_EQ(scene.images[0].width, 64) << "the floats were the larger ones";
  EXPECT_EQ(scene.images[1].width, 16);
  EXPECT_EQ(scene.images[2].width, 32);
  fit_images(scene, 1, diagnostics);
  for (const ImageTexels& image : scene.images) EXPECT_EQ(image.width * image.height, 1);
}

/// A floor of size 2 about the origin in the plane z = 0, seen from the height `distance`, with an image on it.
template <class Real>
CompiledScene<Real> floor_seen_from(double distance, const ImageTexels& image,
                                    const std::string& camera = "perspective", bool nearest = false) {
  Scene scene = described_scene(film_of(32, 32) + "LookAt 0 0 " + std::to_string(distance) +
                                "  0 0 0  0 1 0\nCamera \"" + camera + "\"\nWorldBegin\nLightSource \"infinite\"\n" +
                                "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "
                                "\"point2 uv\" [0 0  1 0  1 1  0 1] \"integer indices\" [0 1 2 0 2 3]");
  scene.images.push_back(image);
  Texture texture;
  texture.kind = TextureKind::image;
  texture.image = 0;
  texture.nearest = nearest;
  scene.textures.push_back(texture);
  Material material;
  material.reflectance = static_cast<uint32_t>(scene.textures.size() - 1);
  scene.materials.push_back(material);
  scene.groups[0].shapes[0].material = static_cast<uint32_t>(scene.materials.size() - 1);
  return compiled_scene<Real>(std::move(scene));
}

/// The texture value that the ray through the raster position finds.
template <class Real>
Real seen_at(const CompiledScene<Real>& scene, double x, double y) {
  const Ray<Real> ray =
      camera_ray(scene.view.camera, Vec2<Real>{static_cast<Real>(x), static_cast<Real>(y)}, Vec2<Real>{}, Real(0));
  // The plane z = 0, with the triangle that contains the point.
  const Real t = -ray.origin.z / ray.direction.z;
  const Vec3<Real> p = ray.origin + ray.direction * t;
  for (uint32_t i = 0; i < scene.view.triangles_count; ++i) {
    const uint32_t* v = scene.view.triangles[i].vertex;
    const Vec3<Real> a = scene.view.positions[v[0]], e1 = scene.view.positions[v[1]] - a,
                     e2 = scene.view.positions[v[2]] - a;
    const Real area = e1.x * e2.y - e1.y * e2.x;
    const Vec3<Real> d = p - a;
    const Hit<Real> hit{
        t, (d.x * e2.y - d.y * e2.x) / area, (e1.x * d.y - e1.y * d.x) / area, {PrimitiveKind::triangle, i}};
    if (hit.b1 < 0 || hit.b2 < 0 || hit.b1 + hit.b2 > 1) continue;
    const SurfaceInteraction<Real> si = surface_interaction(scene.view, ray, hit);
    const uint32_t material = scene.view.surfaces[si.surface].material;
    return evaluate_texture(scene.view, scene.view.materials[material].diffuse.reflectance, texture_point(si, hit)).x;
  }
  ADD_FAILURE() << "the floor was missed";
  return 0;
}

template <class Real>
class PyramidLookup : public ::testing::Test {};
TYPED_TEST_SUITE(PyramidLookup, Reals);

TYPED_TEST(PyramidLookup, ChecksFarAwayAreGrey) {
  // Over 256 checks per side within about one pixel only their mean is left.
  const auto scene = floor_seen_from<TypeParam>(16, checks(256, 256, true));
  for (double x = 15; x < 17; x += 0.037) EXPECT_NEAR(static_cast<double>(seen_at(scene, x, 16.01)), 0.5, 1e-5);
}

TYPED_TEST(PyramidLookup, MagnifiedImagesAreSharp) {
  const auto scene = floor_seen_from<TypeParam>(0.05, checks(64, 64, true));
  // Pixels are 0.1 / 32 of the plane: the centres of four texels, 1 / 32 wide, about the centre.
  std::set<double> values;
  for (const double x : {11.0, 21.0})
    for (const double y : {11.0, 21.0})
      values.insert(std::round(1e4 * static_cast<double>(seen_at(scene, x, y))) / 1e4);
  EXPECT_EQ(values, (std::set<double>{0, 1}));
}

TYPED_TEST(PyramidLookup, OrthographicCamerasFilterByTheirOwnPixels) {
  // Pixels are a sixteenth wide, texels 1 / 128: 8 texels per pixel, at any distance.
  for (const double distance : {0.01, 1000.0}) {
    const auto scene = floor_seen_from<TypeParam>(distance, checks(256, 256, true), "orthographic");
    for (double x = 10; x < 12; x += 0.093) EXPECT_NEAR(static_cast<double>(seen_at(scene, x, 16.01)), 0.5, 1e-5);
    const auto sharp = floor_seen_from<TypeParam>(distance, checks(8, 8, true), "orthographic");
    // From this side x runs to the left: the corner of the image is its last texel.
    EXPECT_NEAR(static_cast<double>(seen_at(sharp, 2, 2)), 1, 1e-4);
    EXPECT_NEAR(static_cast<double>(seen_at(sharp, 6, 2)), 0, 1e-4);
  }
}

TYPED_TEST(PyramidLookup, NearestTexelsStayWhatTheyAre) {
  const auto scene = floor_seen_from<TypeParam>(16, checks(256, 256, true), "perspective", true);
  EXPECT_EQ(scene.view.images_count, 1u);
  for (double x = 15; x < 17; x += 0.037) {
    const double value = static_cast<double>(seen_at(scene, x, 16.01));
    EXPECT_TRUE(value == 0 || value == 1);
  }
}

TEST(PyramidLevels, LogarithmIsContinuousAndClose) {
  EXPECT_EQ(coarse_log2(1), 0);
  EXPECT_EQ(coarse_log2(1024), 10);
  for (float x = 1; x < 1e6f; x *= 1.03f) {
    EXPECT_NEAR(static_cast<double>(coarse_log2(x)), std::log2(static_cast<double>(x)), 0.087);
    EXPECT_LE(coarse_log2(x), coarse_log2(x * 1.001f));
  }
}

/// Grey images take a third of the memory and give the same values.
TEST(PyramidLevels, GreyImagesTakeOneChannel) {
  const auto scene = floor_seen_from<float>(1, checks(4, 4, false));
  EXPECT_EQ(scene.view.images[0].channels, 1u);
  EXPECT_EQ(scene.view.images_count, 3u);
  EXPECT_EQ(scene.view.texel_bytes_count, 16u + 4 + 1);
}

}  // namespace
}  // namespace alhazen::impl::test
