// Scenes, renderers and ray queries of several threads at once give what they give alone. The preset `threads` runs
// these tests under ThreadSanitizer (scripts/check-threads.sh).

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "alhazen/log.h"
#include "alhazen/rays.h"
#include "alhazen/renderer.h"
#include "alhazen/save.h"
#include "support/scene_files.h"
#include "support/temporary_folder.h"

namespace alhazen::test {

namespace {

constexpr int threads = 4;

/// A floor and balls, `number` of them.
Scene scene_of_balls(int number) {
  Scene scene;
  const std::vector<float> positions{-3, 0, -3, 3, 0, -3, 3, 0, 3, -3, 0, 3};
  const std::vector<uint32_t> indices{0, 2, 1, 0, 3, 2};
  const TextureId checks = scene.add(CheckerboardTexture{.even = 0.8, .odd = 0.1});
  scene.add(Shape{scene.add(MeshArrays{.positions = positions, .indices = indices}),
                  scene.add(Diffuse{.reflectance = checks})});
  for (int i = 0; i < number; ++i)
    scene.add(Shape{Sphere{0.4}, scene.add(Principled{.roughness = 0.1 * i}), Transform::translate({0.9 * i, 0.4, 0})});
  scene.add(PointLight{.intensity = 20, .position = {1, 4, 2}});
  scene.set_environment(Colour{0.3, 0.4, 0.6});
  scene.look_at({1, 2, 5}, {1, 0, 0});
  return scene;
}

Settings small_image(const char* backend) {
  Settings settings;
  settings.width = 24, settings.height = 16;
  settings.samples_per_pixel = 8;
  settings.backend = backend;
  settings.threads = 3;
  if (settings.backend == "serial") settings.threads = 0;
  return settings;
}

/// Calls `work` with 0 to threads - 1, each on a thread of its own, all at once.
void at_once(const std::function<void(int)>& work) {
  std::atomic<int> waiting{threads};
  std::vector<std::thread> all;
  for (int i = 0; i < threads; ++i)
    all.emplace_back([&, i] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      work(i);
    });
  for (std::thread& thread : all) thread.join();
}

using Planes = std::vector<std::vector<float>>;

}  // namespace

TEST(Threads, RenderScenesOfTheirOwn) {
  for (const char* const backend : {"serial", "openmp"}) {
    Planes expected[threads], found[threads];
    for (int i = 0; i < threads; ++i) expected[i] = render(scene_of_balls(i), small_image(backend)).planes;
    at_once([&](int i) { found[i] = render(scene_of_balls(i), small_image(backend)).planes; });
    for (int i = 0; i < threads; ++i) EXPECT_EQ(found[i], expected[i]) << backend;
  }
}

TEST(Threads, RenderOneScene) {
  const Scene scene = scene_of_balls(3);
  Settings settings = small_image("openmp");
  settings.aovs = {"albedo", "normal", "object"};
  settings.denoiser = "builtin";
  settings.noise = 0.2;
  const Planes expected = render(scene, settings).planes;
  Planes found[threads];
  at_once([&](int i) { found[i] = render(scene, settings).planes; });
  for (const Planes& planes : found) EXPECT_EQ(planes, expected);
}

TEST(Threads, ReadAndSaveFiles) {
  impl::test::TemporaryFolder folder;
  const std::string file = folder.write_text("scene.pbrt", impl::test::cornell_box(12));
  const Planes expected = render(file, small_image("serial")).planes;
  Planes found[threads];
  at_once([&](int i) {
    const Scene scene = Scene::load(file);
    const RenderedImage image = render(scene, small_image("serial"));
    for (const char* const extension : {".exr", ".png", ".jpg", ".hdr"})
      save(image, folder.file(std::to_string(i) + extension));
    found[i] = image.planes;
  });
  for (const Planes& planes : found) EXPECT_EQ(planes, expected);
}

TEST(Threads, HaveRenderersOfTheirOwn) {
  const Scene scene = scene_of_balls(2);
  const Planes expected = render(scene, small_image("openmp")).planes;
  Planes found[threads];
  at_once([&](int i) {
    Renderer renderer(small_image("openmp"));
    Scene own = scene;
    renderer.start(own, [](const Progress&) { return true; });
    renderer.render_pass();
    own.look_at({1, 2, 5}, {1, 0, 0});
    found[i] = renderer.render(own).planes;
  });
  for (const Planes& planes : found) EXPECT_EQ(planes, expected);
}

TEST(Threads, StopARendererOfAnother) {
  const Scene scene = scene_of_balls(3);
  Settings settings = small_image("openmp");
  settings.samples_per_pixel = 1 << 24;
  for (int i = 0; i < 5; ++i) {
    Renderer renderer(settings);
    std::atomic<bool> is_done{false};
    std::thread other([&] {
      // Before the start it has no effect.
      while (!is_done) {
        renderer.stop();
        std::this_thread::yield();
      }
    });
    try {
      EXPECT_FALSE(renderer.render(scene, [](const Progress&) { return true; }).complete);
    } catch (const Cancelled&) {
      ADD_FAILURE() << "renders return an image";
    }
    is_done = true;
    other.join();
  }
}

TEST(Threads, ShareRayQueries) {
  const RayQueries queries(scene_of_balls(4));
  constexpr size_t count = 4000;
  std::vector<float> origins, directions;
  for (size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(i % 80) / 20 - 1, z = static_cast<float>(i / 80) / 20 - 1;
    origins.insert(origins.end(), {x, 3, z});
    directions.insert(directions.end(), {0.1f * z, -1, 0.1f});
  }
  const RayArrays<float> rays{origins.data(), directions.data(), count};
  std::vector<float> expected(count), found[threads];
  HitArrays<float> hits;
  hits.t = expected.data();
  queries.closest_hits(rays, hits, 1);
  at_once([&](int i) {
    found[i].resize(count);
    HitArrays<float> own;
    own.t = found[i].data();
    const RayQueries copy = queries;
    copy.closest_hits(rays, own, 1 + i % 3);
    std::vector<uint8_t> occluded(count);
    copy.occluded(rays, occluded.data(), 1 + i % 3);
  });
  for (const std::vector<float>& t : found) EXPECT_EQ(t, expected);
}

TEST(Threads, LogOneLineAtATime) {
  int inside = 0;  // not atomic: calls of the log must not overlap
  size_t lines = 0;
  set_log([&](LogLevel, const std::string&) {
    EXPECT_EQ(++inside, 1);
    ++lines;
    --inside;
  });
  at_once([&](int i) { render(scene_of_balls(i), small_image("serial")); });
  set_log({});
  EXPECT_GE(lines, size_t{4 * threads});
  const size_t before = lines;
  render(scene_of_balls(1), small_image("serial"));
  EXPECT_EQ(lines, before);
}

}  // namespace alhazen::test
