// Camera rays of known pixels, the thin lens, and pixel filters that keep a constant image constant.

#include <gtest/gtest.h>

#include "core/cameras/camera.h"
#include "support/compiled_scenes.h"
#include "support/random.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

const std::string sky = "WorldBegin LightSource \"infinite\"";

template <class Real>
class CameraOf : public ::testing::Test {};
TYPED_TEST_SUITE(CameraOf, Reals);

template <class Real>
Ray<Real> ray_through(const CompiledScene<Real>& scene, double x, double y, const Vec2d& lens = {}) {
  return camera_ray(scene.view.camera, Vec2<Real>{static_cast<Real>(x), static_cast<Real>(y)},
                    Vec2<Real>{static_cast<Real>(lens.x), static_cast<Real>(lens.y)}, Real(0));
}

template <class Real>
void expect_along(const Vec3<Real>& actual, const Vec3d& expected) {
  EXPECT_NEAR(length(convert<double>(actual) - normalize(expected)), 0, by_precision<Real>(1e-6, 1e-14))
      << actual.x << " " << actual.y << " " << actual.z;
}

/// Camera space: x right, y up, z into the scene; rows count from the top.
TYPED_TEST(CameraOf, PixelsOfAPlainCamera) {
  const auto scene =
      compiled_scene_of<TypeParam>(film_of(200, 100) + "Camera \"perspective\" \"float fov\" 90\n" + sky);
  expect_along(ray_through(scene, 100, 50).direction, {0, 0, 1});
  expect_along(ray_through(scene, 100, 0).direction, {0, 1, 1});
  expect_along(ray_through(scene, 0, 50).direction, {-2, 0, 1});
  expect_along(ray_through(scene, 200, 100).direction, {2, -1, 1});
  EXPECT_TRUE(is_zero(ray_through(scene, 3, 7).origin));
}

/// The field of view is over the shorter side.
TYPED_TEST(CameraOf, TallImage) {
  const auto scene = compiled_scene_of<TypeParam>(film_of(50, 100) + "Camera \"perspective\" \"float fov\" 60\n" + sky);
  const double t = std::tan(pi<double> / 6);
  expect_along(ray_through(scene, 50, 50).direction, {t, 0, 1});
  expect_along(ray_through(scene, 25, 0).direction, {0, 2 * t, 1});
}

TYPED_TEST(CameraOf, ScreenWindowAndAspect) {
  const auto window = compiled_scene_of<TypeParam>(
      film_of(100, 100) + "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [-0.5 1 -2 0.25]\n" + sky);
  expect_along(ray_through(window, 0, 0).direction, {-0.5, 0.25, 1});
  expect_along(ray_through(window, 100, 100).direction, {1, -2, 1});
  const auto aspect = compiled_scene_of<TypeParam>(
      film_of(100, 100) + "Camera \"perspective\" \"float fov\" 90 \"float frameaspectratio\" 3\n" + sky);
  expect_along(ray_through(aspect, 100, 0).direction, {3, 1, 1});
}

TYPED_TEST(CameraOf, LookAtAndMirrored) {
  const std::string look = "LookAt 1 2 3  1 2 8  0 1 0\nCamera \"perspective\" \"float fov\" 90\n" + sky;
  const auto scene = compiled_scene_of<TypeParam>(film_of(100, 100) + look);
  EXPECT_TRUE(ray_through(scene, 50, 50).origin == (Vec3<TypeParam>{1, 2, 3}));
  // Looking along +z with y up, +x is to the right in the format's left-handed space.
  expect_along(ray_through(scene, 100, 0).direction, {1, 1, 1});
  const auto mirrored = compiled_scene_of<TypeParam>(film_of(100, 100) + "Scale -1 1 1\n" + look);
  expect_along(ray_through(mirrored, 100, 0).direction, {-1, 1, 1});
  const auto scaled = compiled_scene_of<TypeParam>(film_of(100, 100) + "Scale 7 7 7\n" + look);
  expect_along(ray_through(scaled, 100, 0).direction, {1, 1, 1});
  EXPECT_NEAR(static_cast<double>(length(ray_through(scaled, 50, 50).origin - Vec3<TypeParam>{1, 2, 3})), 0, 1e-6);
}

/// All rays of one pixel intersect on the plane of focus, wherever they pass the lens, and start within the lens.
TYPED_TEST(CameraOf, LensFocuses) {
  using Real = TypeParam;
  const auto scene = compiled_scene_of<Real>(
      film_of(100, 100) +
      "Camera \"perspective\" \"float fov\" 70 \"float lensradius\" 0.5 \"float focaldistance\" 4\n" + sky);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.between(0, 100), y = random.between(0, 100);
    const Ray<Real> ray = ray_through(scene, x, y, random.uniform_2d<double>());
    EXPECT_EQ(ray.origin.z, Real(0));
    EXPECT_LE(length(ray.origin), Real(0.5 + 1e-6));
    EXPECT_NEAR(static_cast<double>(length(ray.direction)), 1, 1e-6);
    const Vec3d crossing = convert<double>(ray.origin + ray.direction * (Real(4) / ray.direction.z));
    const double t = std::tan(35 * pi<double> / 180);
    EXPECT_NEAR(crossing.x, 4 * t * (x / 50 - 1), by_precision<Real>(1e-5, 1e-13));
    EXPECT_NEAR(crossing.y, 4 * t * (1 - y / 50), by_precision<Real>(1e-5, 1e-13));
  }
}

/// Parallel rays that start on the screen window; with a lens they intersect on the plane of focus.
TYPED_TEST(CameraOf, Orthographic) {
  using Real = TypeParam;
  const std::string camera = "LookAt 1 2 3  1 2 8  0 1 0\nCamera \"orthographic\" ";
  const auto scene = compiled_scene_of<Real>(film_of(200, 100) + camera + sky);
  for (const double x : {0.0, 50.0, 200.0}) {
    const Ray<Real> ray = ray_through(scene, x, 25);
    expect_along(ray.direction, {0, 0, 1});
    EXPECT_NEAR(length(convert<double>(ray.origin) - Vec3d{1 + x / 50 - 2, 2.5, 3}), 0, 1e-6);
  }
  const auto window =
      compiled_scene_of<Real>(film_of(100, 100) + camera + "\"float screenwindow\" [ 0 10 -5 0 ]\n" + sky);
  EXPECT_NEAR(length(convert<double>(ray_through(window, 0, 0).origin) - Vec3d{1, 2, 3}), 0, 1e-6);
  EXPECT_NEAR(length(convert<double>(ray_through(window, 100, 100).origin) - Vec3d{11, -3, 3}), 0, 1e-6);
  const auto lens = compiled_scene_of<Real>(film_of(100, 100) + "Camera \"orthographic\" \"float lensradius\" 0.5 " +
                                            "\"float focaldistance\" 4\n" + sky);
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Ray<Real> ray = ray_through(lens, 75, 50, random.uniform_2d<double>());
    EXPECT_LE(length(convert<double>(ray.origin) - Vec3d{0.5, 0, 0}), 0.5 + 1e-6);
    const Vec3d crossing = convert<double>(ray.origin + ray.direction * (Real(4) / ray.direction.z));
    EXPECT_NEAR(length(crossing - Vec3d{0.5, 0, 4}), 0, 1e-5);
  }
}

/// y is up; the left and right edges look along +x, and a quarter of the width further along +z.
TYPED_TEST(CameraOf, Equirectangular) {
  const auto scene = compiled_scene_of<TypeParam>(
      film_of(200, 100) + "Camera \"spherical\" \"string mapping\" \"equirectangular\"\n" + sky);
  expect_along(ray_through(scene, 0, 50).direction, {1, 0, 0});
  expect_along(ray_through(scene, 50, 50).direction, {0, 0, 1});
  expect_along(ray_through(scene, 100, 50).direction, {-1, 0, 0});
  expect_along(ray_through(scene, 37, 0).direction, {0, 1, 0});
  expect_along(ray_through(scene, 50, 25).direction, {0, 1, 1});
}

/// The centre of the square looks up, the centres of its sides along the axes of the horizon, the corners down.
TYPED_TEST(CameraOf, EqualArea) {
  const auto scene = compiled_scene_of<TypeParam>(film_of(100, 100) + "Camera \"spherical\"\n" + sky);
  expect_along(ray_through(scene, 50, 50).direction, {0, 1, 0});
  expect_along(ray_through(scene, 100, 50).direction, {1, 0, 0});
  expect_along(ray_through(scene, 50, 100).direction, {0, 0, 1});
  expect_along(ray_through(scene, 0, 0).direction, {0, -1, 0});
  // Past an edge the square continues rotated.
  expect_along(ray_through(scene, 103, 30).direction, convert<double>(ray_through(scene, 97, 70).direction));
  // Equal areas: half of the pixels look up, a quarter above 30 degrees.
  int above = 0, high = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const double up = static_cast<double>(ray_through(scene, x + 0.5, y + 0.5).direction.y);
      above += up > 0;
      high += up > 0.5;
    }
  EXPECT_NEAR(above, 5000, 120);
  EXPECT_NEAR(high, 2500, 120);
}

/// A quarter of the area between the rays of a pixel, whatever the scale of camera space.
TYPED_TEST(CameraOf, FootprintOfAPixel) {
  for (const char* scale : {"", "Scale 3 3 3\n"}) {
    const auto scene =
        compiled_scene_of<TypeParam>(film_of(100, 100) + scale + "Camera \"perspective\" \"float fov\" 90\n" + sky);
    const auto footprint = [&](const Vec3d& at, const Vec3d& normal) {
      return static_cast<double>(
          pixel_footprint(scene.view.camera, convert<TypeParam>(at), convert<TypeParam>(normalize(normal))));
    };
    // On the plane z = 10 pixels are 0.2 wide, at the centre and at the edge.
    EXPECT_NEAR(footprint({0, 0, 10}, {0, 0, -1}), 0.01, 1e-6);
    EXPECT_NEAR(footprint({7, -4, 10}, {0, 0, 1}), 0.01, 1e-6);
    EXPECT_NEAR(footprint({0, 0, 10}, {0, 1, 1}), 0.01 * std::sqrt(2), 1e-6);
    EXPECT_NEAR(footprint({0, 0, 10}, {0, 1, 0}), 0.16, 1e-6);
  }
}

/// Also if the filter has negative parts, whose samples have negative weights.
TYPED_TEST(CameraOf, EveryFilterKeepsAConstantImage) {
  for (const char* filter : {"box", "triangle", "gaussian", "mitchell", "sinc"}) {
    const auto scene = compiled_scene_of<TypeParam>(film_of(4, 4) + "PixelFilter \"" + filter +
                                                    "\"\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [0.5 2 7]");
    for (const SamplerType sampler : all_samplers)
      for (uint32_t x = 0; x < 4; ++x) {
        const Vec3d colour = render_pixel(scene.view, Take{IntegratorKind::path, sampler, 3, 64, 5}, x, 2);
        EXPECT_NEAR(colour.x, 0.5, 1e-5) << filter;
        EXPECT_NEAR(colour.y, 2, 1e-5) << filter;
        EXPECT_NEAR(colour.z, 7, 1e-5) << filter;
      }
  }
}

}  // namespace
}  // namespace alhazen::impl::test
