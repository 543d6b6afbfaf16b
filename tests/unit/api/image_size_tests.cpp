// The size of an image follows from the settings and the film.

#include <gtest/gtest.h>

#include "alhazen/renderer.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

alhazen::Scene wide_scene() {
  alhazen::Scene scene;
  add_floor(scene);
  Film film = scene.film();
  film.width = 60, film.height = 20;
  scene.set_film(film);
  return scene;
}

std::pair<int, int> size_of(int64_t width, int64_t height) {
  Settings settings = quick_settings();
  settings.samples_per_pixel = 1;
  settings.width = width, settings.height = height;
  const RenderedImage image = render(wide_scene(), settings);
  return {image.width, image.height};
}

}  // namespace

TEST(ImageSize, OneSideFollowsFromTheOther) {
  using Size = std::pair<int, int>;
  EXPECT_EQ(size_of(0, 0), Size(60, 20));
  EXPECT_EQ(size_of(30, 0), Size(30, 10));
  EXPECT_EQ(size_of(0, 5), Size(15, 5));
  EXPECT_EQ(size_of(1, 0), Size(1, 1));
  EXPECT_EQ(size_of(7, 9), Size(7, 9));
}

TEST(ImageSize, SidesOutOfRangeAreRefused) {
  for (const auto& [width, height] : {std::pair<int64_t, int64_t>{-1, 0}, {0, -1}, {-1, -1}, {100'001, 0}, {0, 50'000}})
    EXPECT_THROW(size_of(width, height), InputError) << width << " x " << height;
}

TEST(ImageSize, ImagesSayWhatPartTheyAre) {
  Settings settings = quick_settings();
  settings.width = 30, settings.height = 0;
  settings.pixel_bounds = {{10, 25, 3, 9}};
  const RenderedImage image = render(wide_scene(), settings);
  EXPECT_EQ(image.width, 15);
  EXPECT_EQ(image.height, 6);
  EXPECT_EQ(image.x, 10);
  EXPECT_EQ(image.y, 3);
  EXPECT_EQ(image.full_width, 30);
  EXPECT_EQ(image.full_height, 10);
  EXPECT_EQ(image.samples, 4);
  EXPECT_GT(image.seconds, 0);
}

}  // namespace alhazen::test
