#include "view/view_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/alhazen.h"
#include "alhazen/scene.h"

namespace alhazen::impl::test {

namespace {

::alhazen::Camera camera_from(const ::alhazen::Vec3& eye, const ::alhazen::Vec3& target, Handedness handedness) {
  ::alhazen::Camera camera;
  camera.transform = ::alhazen::Transform::look_at(eye, target, {0, 1, 0}, handedness);
  camera.fov = 35;
  return camera;
}

void expect_near(const ::alhazen::Vec3& a, const ::alhazen::Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(a.z, b.z, 1e-9);
}

}  // namespace

TEST(ViewCamera, IsPlacedWhereThePageHasSeenIt) {
  const SceneExtent extent{{0, 1, 0}, 3, {0, 1, 0}};
  for (const Handedness handedness : {Handedness::left, Handedness::right}) {
    ::alhazen::Camera camera = camera_from({4, 2, 5}, {0, 1, 0}, handedness);
    EXPECT_EQ(is_left_handed(camera), handedness == Handedness::left);
    camera.lens_radius = 0.1;
    camera.focal_distance = 4;
    const PageCamera page = page_camera(camera, extent);
    expect_near(page.position, {4, 2, 5});
    EXPECT_EQ(page.fov, 35);
    EXPECT_EQ(page.focus, 4);
    expect_near(page.up, {0, 1, 0});
    EXPECT_NEAR(std::hypot(page.target.x - 4, page.target.y - 2, page.target.z - 5), 4, 1e-9) << "it is what is sharp";
    const ::alhazen::Camera placed = placed_camera(camera, page);
    for (const ::alhazen::Vec3& point : {::alhazen::Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
      expect_near(placed.transform.start.point(point), camera.transform.start.point(point));
    EXPECT_EQ(placed.lens_radius, 0.1);
    EXPECT_NEAR(placed.focal_distance, 4, 1e-12);
  }
}

TEST(ViewCamera, KeepsItsRoll) {
  ::alhazen::Camera camera = camera_from({0, 0, 5}, {0, 0, 0}, Handedness::right);
  camera.transform = camera.transform.start * ::alhazen::Transform::rotate(30, {0, 0, 1});
  const ::alhazen::Camera placed = placed_camera(camera, page_camera(camera, {}));
  expect_near(placed.transform.start.direction({1, 0, 0}), camera.transform.start.direction({1, 0, 0}));
}

TEST(ViewCamera, ALensInAScaledSpaceHasTheSizeOfTheWorld) {
  ::alhazen::Camera camera = camera_from({0, 0, 5}, {0, 0, 0}, Handedness::right);
  camera.transform = camera.transform.start * ::alhazen::Transform::scale(2);
  camera.lens_radius = 0.1;
  camera.focal_distance = 2;
  const PageCamera page = page_camera(camera, {});
  EXPECT_NEAR(page.aperture, 0.2, 1e-12);
  EXPECT_NEAR(*page.focus, 4, 1e-12);
}

/// Each pixel of a coarse picture has the mean of those that it stands for, also at the edges of images whose sides are
/// no multiples of the step.
TEST(ViewCamera, CoarsePixelsAreWhereTheirFinePixelsAre) {
  ::alhazen::Scene scene = ::alhazen::Scene::load(std::string(ALHAZEN_SOURCE_DIR) + "/scenes/spheres.pbrt");
  const ::alhazen::Camera camera = scene.camera();
  Settings settings;
  settings.samples_per_pixel = 64;
  settings.filter = "box,0.5";
  settings.aovs = {"albedo"};
  settings.width = 100;
  settings.height = 75;
  const RenderedImage fine = ::alhazen::render(scene, settings);
  const PixelRegion region{8, 4, 70, 61};
  constexpr int step = 8;
  scene.set_camera(coarse_camera(camera, 100, 75, region, step));
  settings.width = 9;
  settings.height = 8;
  settings.samples_per_pixel = 256;
  const RenderedImage coarse = ::alhazen::render(scene, settings);
  double difference = 0, mean = 0;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 8; ++x) {
      double sum = 0;
      for (int j = 0; j < step; ++j)
        for (int i = 0; i < step; ++i)
          sum += static_cast<double>(fine.plane("albedo.G")[(region.y + y * step + j) * 100 + region.x + x * step + i]);
      const double value = static_cast<double>(coarse.plane("albedo.G")[y * 9 + x]);
      difference += std::abs(value - sum / (step * step));
      mean += value;
    }
  EXPECT_LT(difference / mean, 0.02);
}

TEST(ViewCamera, IsPlacedByOptionsOfTheCommandLine) {
  PageCamera camera{{1e6, -2, 0.1}, {0, 0, 0}, {0, 1, 0}, 39.5, 0, 4.0};
  EXPECT_EQ(camera_options(camera), "--look-at 1000000,-2,0.1,0,0,0,0,1,0 --fov 39.5 --aperture 0");
  camera.fov.reset();
  camera.aperture = 0.25;
  EXPECT_EQ(camera_options(camera), "--look-at 1000000,-2,0.1,0,0,0,0,1,0 --aperture 0.25 --focus 4");
}

}  // namespace alhazen::impl::test
