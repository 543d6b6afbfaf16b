#include "alhazen/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace alhazen {

namespace {

/// A red floor and a ball under a lamp and the sky.
struct Room {
  Room() {
    const std::vector<float> positions{-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2};
    const std::vector<uint32_t> indices{0, 2, 1, 0, 3, 2};
    floor = scene.add(Diffuse{.reflectance = Colour{0.7, 0.2, 0.1}});
    scene.add(alhazen::Shape{scene.add(MeshArrays{.positions = positions, .indices = indices}), floor});
    scene.add(alhazen::Shape{Sphere{.radius = 0.5}, scene.add(Diffuse{})});
    scene.set_environment(Colour{0.3, 0.4, 0.6});
    scene.look_at({1, 2, 4}, {0, 0, 0});
    alhazen::Film film = scene.film();
    film.width = 24, film.height = 16;
    scene.set_film(film);
  }

  alhazen::Scene scene;
  MaterialId floor;
};

Settings few_samples() {
  Settings settings;
  settings.samples_per_pixel = 12;
  settings.aovs = {"depth"};
  return settings;
}

void expect_same(const RenderedImage& a, const RenderedImage& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.planes, b.planes);
}

TEST(Renderer, GivesTheImagesOfRender) {
  Room room;
  Settings settings = few_samples();
  Renderer renderer(settings);
  expect_same(renderer.render(room.scene), render(room.scene, settings));
  room.scene.look_at({-3, 1, 2}, {0, 0.3, 0});
  EXPECT_FALSE(renderer.start(room.scene).is_new);
  while (renderer.render_pass()) {
  }
  expect_same(renderer.finish(), render(room.scene, settings));
}

TEST(Renderer, ADenoisedImageOnTheWayLeavesItsBitsAlone) {
  Room room;
  Settings settings = few_samples();
  settings.denoiser = "builtin";
  Renderer plain(settings), watched(settings);
  plain.start(room.scene);
  watched.start(room.scene);
  while (plain.render_pass(4)) {
  }
  for (bool goes_on = true; goes_on;) {
    goes_on = watched.render_pass(4);
    const RenderedImage noisy = watched.image(), denoised = watched.denoised_image(), again = watched.image();
    expect_same(noisy, again);
    EXPECT_EQ(noisy.denoiser, "");
    EXPECT_EQ(again.denoiser, "");
    EXPECT_EQ(denoised.denoiser, "builtin");
    EXPECT_EQ(denoised.samples, noisy.samples);
    EXPECT_NE(denoised.planes[0], noisy.planes[0]);
    EXPECT_EQ(denoised.planes.back(), noisy.planes.back());  // depth
    if (!goes_on) expect_same(denoised, plain.denoised_image());
  }
  const RenderedImage last = watched.denoised_image(), finished = watched.finish();
  expect_same(last, finished);
  EXPECT_EQ(finished.denoiser, "builtin");
  expect_same(finished, plain.finish());
  expect_same(finished, render(room.scene, settings));
}

TEST(Renderer, ADenoisedImageNeedsADenoiserAndAnImage) {
  Room room;
  Renderer renderer(few_samples());
  EXPECT_THROW(renderer.denoised_image(), InputError);
  renderer.start(room.scene);
  renderer.render_pass(4);
  EXPECT_THROW(renderer.denoised_image(), InputError);
  EXPECT_EQ(renderer.image().samples, 4);  // it is still under way
}

TEST(Renderer, ADenoisedImageWithoutSamplesIsEmpty) {
  Room room;
  Settings settings = few_samples();
  settings.denoiser = "builtin";
  Renderer renderer(settings);
  renderer.start(room.scene);
  EXPECT_EQ(renderer.denoised_image().width, 0);
}

TEST(Renderer, BuildsOnlyForWhatNeedsIt) {
  Room room;
  Settings settings = few_samples();
  Renderer renderer(settings);
  EXPECT_TRUE(renderer.start(room.scene).is_new);
  const auto expect = [&](bool is_new, const char* what) {
    SCOPED_TRACE(what);
    renderer.set_settings(settings);
    EXPECT_EQ(renderer.start(room.scene).is_new, is_new);
    while (renderer.render_pass()) {
    }
    expect_same(renderer.finish(), render(room.scene, settings));
  };
  expect(false, "nothing");
  settings.width = 20, settings.height = 20;
  expect(false, "another size");
  settings.samples_per_pixel = 7;
  settings.seed = 3;
  expect(false, "other samples");
  settings.transparent_background = true;
  settings.aovs = {"albedo", "variance"};
  expect(false, "alpha and layers");
  settings.transparent_background = false;
  settings.clamp_indirect = 0.1;
  expect(false, "a limit");
  settings.clamp_indirect = 0;
  settings.integrator = "iterative";
  expect(true, "another integrator, of which light is not searched");
  settings.integrator.clear();
  settings.aovs = {"object"};
  expect(true, "names");
  settings.filter = "box";
  expect(true, "a filter");
  settings.precision = "double";
  expect(true, "a precision");
  room.scene.set(room.floor, Diffuse{.reflectance = Colour{0.1, 0.8, 0.1}});
  expect(false, "a material's colour");
  room.scene.set(room.floor, CoatedDiffuse{.reflectance = Colour{0.1, 0.8, 0.1}});
  expect(false, "a material's kind");
  room.scene.set(room.floor, Diffuse{.reflectance = room.scene.add(CheckerboardTexture{})});
  expect(true, "a texture over uv");
  settings.look_at = {0, 4, 0.1, 0, 0, 0};
  expect(false, "a camera by settings");
}

TEST(Renderer, BuildsNothingForAnotherDefaultViewOrUnusedTexture) {
  alhazen::Scene scene;
  const MaterialId material = scene.add(Diffuse{});
  scene.add(alhazen::Shape{Sphere{}, material});
  Settings settings = few_samples();
  settings.width = 24, settings.height = 16;
  Renderer renderer(settings);
  renderer.start(scene);
  EXPECT_FALSE(renderer.start(scene).is_new);
  scene.set(material, Diffuse{.reflectance = Colour{1, 0, 0}});  // its first own texture
  EXPECT_FALSE(renderer.start(scene).is_new);
  while (renderer.render_pass()) {
  }
  expect_same(renderer.finish(), render(scene, settings));
}

/// A room whose walls are invisible from outside, a card whose two sides coincide, and a window of a lattice.
struct OneSidedRoom {
  OneSidedRoom() {
    const std::vector<float> quad{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const std::vector<uint32_t> front{0, 1, 2, 0, 2, 3}, both{0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0};
    const MeshId wall = scene.add(MeshArrays{.positions = quad, .indices = front});
    const MeshId card = scene.add(MeshArrays{.positions = quad, .indices = both});
    Material paint(Diffuse{.reflectance = Colour{0.7, 0.5, 0.3}});
    paint.double_sided = false;
    walls = scene.add(paint);
    paint.bsdf = Diffuse{.reflectance = Colour{0.2, 0.5, 0.8}};
    cards = scene.add(paint);
    for (const double turn : {0.0, 90.0, 180.0, 270.0})
      scene.add(alhazen::Shape{wall, walls, Transform::rotate(turn, {0, 1, 0}) * Transform::translate({0, 0, -1})});
    scene.add(alhazen::Shape{card, cards, Transform::rotate(40, {0, 1, 0}) * Transform::scale(0.4)});
    scene.add(PointLight{.intensity = 5, .position = {0.2, 3, 1}});
    scene.look_at({1, 2, 4}, {0, 0, 0});
    alhazen::Film film = scene.film();
    film.width = 32, film.height = 24;
    scene.set_film(film);
  }

  alhazen::Scene scene;
  MaterialId walls, cards;
};

TEST(Renderer, ChangesOneSidedMaterialsInPlace) {
  OneSidedRoom room;
  const Settings settings = few_samples();
  Renderer renderer(settings);
  renderer.start(room.scene);
  const auto expect_kept = [&](const char* what) {
    SCOPED_TRACE(what);
    EXPECT_FALSE(renderer.start(room.scene).is_new);
    while (renderer.render_pass()) {
    }
    expect_same(renderer.finish(), render(room.scene, settings));
  };
  expect_kept("nothing");
  for (const MaterialId id : {room.walls, room.cards}) {
    Material material = room.scene.material(id);
    material.bsdf = Principled{.base_colour = Colour{0.1, 0.9, 0.2}, .metallic = 1};
    room.scene.set(id, material);
    expect_kept("another kind");
    room.scene.look_at({-4, 1, id == room.walls ? -1.0 : 1.0}, {0, 0, 0});
    expect_kept("another camera");
  }
  Material open = room.scene.material(room.walls);
  open.double_sided = true;
  room.scene.set(room.walls, open);
  EXPECT_TRUE(renderer.start(room.scene).is_new);
}

TEST(Renderer, IsOfTheSceneThatItIsGiven) {
  Room first;
  Renderer renderer(few_samples());
  renderer.start(first.scene);
  const alhazen::Scene copy = first.scene;
  EXPECT_TRUE(renderer.start(copy).is_new);
  EXPECT_TRUE(renderer.start(first.scene).is_new);
}

TEST(Renderer, ShowsTheImageBetweenPasses) {
  Room room;
  Settings settings = few_samples();
  Renderer renderer(settings);
  renderer.start(room.scene);
  EXPECT_TRUE(renderer.image().planes.empty());
  EXPECT_TRUE(renderer.render_pass(3));
  Settings four = settings;
  four.samples_per_pixel = 4;
  expect_same(renderer.image(), render(room.scene, four));
  EXPECT_FALSE(renderer.image().complete);
  EXPECT_NEAR(renderer.progress().fraction, 4.0 / 12, 1e-9);
  EXPECT_FALSE(renderer.render_pass(1000));
  EXPECT_TRUE(renderer.image().complete);
  expect_same(renderer.finish(), render(room.scene, settings));
}

TEST(Renderer, StopsAndGoesOnWithAnotherImage) {
  Room room;
  Settings settings = few_samples();
  settings.samples_per_pixel = 1'000'000;
  Renderer renderer(settings);
  renderer.start(room.scene);
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    renderer.stop();
  });
  while (renderer.render_pass()) {
  }
  stopper.join();
  const RenderedImage stopped = renderer.finish();
  EXPECT_FALSE(stopped.complete);
  renderer.set_settings(few_samples());
  expect_same(renderer.render(room.scene), render(room.scene, few_samples()));
  renderer.stop();  // nothing is under way
}

TEST(Renderer, CallsBackBetweenPassesAndRethrows) {
  Room room;
  Settings settings = few_samples();
  settings.samples_per_pixel = 4096;
  Renderer renderer(settings);
  int passes = 0;
  const RenderedImage image = renderer.render(room.scene, {}, [&](const Renderer& r) {
    EXPECT_FALSE(r.image().planes.empty());
    return ++passes < 2;
  });
  EXPECT_EQ(passes, 2);
  EXPECT_FALSE(image.complete);
  struct Own : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  EXPECT_THROW(renderer.render(room.scene, {}, [](const Renderer&) -> bool { throw Own("mine"); }), Own);
  EXPECT_THROW(renderer.render(room.scene, [](const Progress&) -> bool { throw Own("mine"); }), Own);
  renderer.set_settings(few_samples());
  expect_same(renderer.render(room.scene), render(room.scene, few_samples()));
}

TEST(Renderer, RefusesWhatIsOutOfOrder) {
  Renderer renderer;
  EXPECT_THROW(renderer.render_pass(), alhazen::InputError);
  EXPECT_THROW(renderer.image(), alhazen::InputError);
  EXPECT_THROW(renderer.finish(), alhazen::InputError);
  Room room;
  renderer.set_settings(few_samples());
  renderer.start(room.scene);
  EXPECT_THROW(renderer.render_pass(-1), alhazen::InputError);
  renderer.finish();
  EXPECT_THROW(renderer.render_pass(), alhazen::InputError);
  Settings wrong = few_samples();
  wrong.backend = "none";
  renderer.set_settings(wrong);
  EXPECT_THROW(renderer.start(room.scene), alhazen::InputError);
  EXPECT_THROW(renderer.render_pass(), alhazen::InputError);
}

TEST(Renderer, SeveralAreIndependent) {
  Room room;
  const RenderedImage expected = render(room.scene, few_samples());
  std::vector<std::thread> threads;
  std::vector<RenderedImage> images(4);
  for (RenderedImage& image : images) threads.emplace_back([&] { image = Renderer(few_samples()).render(room.scene); });
  for (std::thread& thread : threads) thread.join();
  for (const RenderedImage& image : images) expect_same(image, expected);
}

}  // namespace

}  // namespace alhazen
