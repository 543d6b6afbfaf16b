// What a Renderer takes from a change to the first sample: of a large scene, the pbrt file that ALHAZEN_BENCH_SCENE
// names, and of 10,000 instances.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderer.h"

namespace alhazen {
namespace {

Settings bench_settings() {
  Settings settings;
  settings.samples_per_pixel = 64;
  settings.width = 320, settings.height = 180;
  return settings;
}

/// A scene with a renderer that has built it.
struct Built {
  explicit Built(Scene&& its) : scene(std::move(its)), renderer(bench_settings()) { renderer.start(scene); }

  Scene scene;
  Renderer renderer;
};

Built& large_scene() {
  static Built built = [] {
    const char* const file = std::getenv("ALHAZEN_BENCH_SCENE");
    Built large(Scene::load(file));
    return large;
  }();
  return built;
}

/// A pyramid of `triangles` triangles, or a few more, `count` times over a floor, under a lamp and a map. Unless they
/// have many triangles, copies are in the BVH of the world.
Scene many_instances(int count, int triangles) {
  Scene scene;
  std::vector<float> positions{0, 0.5f, 0};
  std::vector<uint32_t> indices;
  for (int i = 0; i < triangles; ++i) {
    const double angle = 6.283185307179586 * i / triangles;
    positions.insert(positions.end(),
                     {static_cast<float>(0.3 * std::cos(angle)), 0, static_cast<float>(0.3 * std::sin(angle))});
    indices.insert(indices.end(), {0, 1 + static_cast<uint32_t>((i + 1) % triangles), 1 + static_cast<uint32_t>(i)});
  }
  const GroupId group = scene.add_group();
  scene.add(Shape{scene.add(MeshArrays{.positions = positions, .indices = indices})}, group);
  for (int i = 0; i < count; ++i) scene.add(Instance{group, Transform::translate({i % 100 - 50.0, 0, i / 100 - 50.0})});
  scene.add(Shape{Disk{100}, {}, Transform::rotate(-90, {1, 0, 0})});
  scene.add(PointLight{500, {0, 20, 0}});
  scene.set_environment(Colour(0.5));
  scene.look_at({0, 30, 80}, {0, 0, 0});
  return scene;
}

/// Times `start` after each change, in seconds as it reports them. A change of the wrong parts is an error.
void measure(benchmark::State& state, Built& built, const std::function<void(Scene&, double)>& change) {
  double step = 0;
  for (auto _ : state) {
    change(built.scene, step += 0.01);
    const BuildReport report = built.renderer.start(built.scene);
    if (report.is_new) return state.SkipWithError("everything was built anew");
    state.SetIterationTime(report.seconds);
  }
}

void of_large_scene(benchmark::State& state, const std::function<void(Scene&, double)>& change) {
  measure(state, large_scene(), change);
}

/// With `Built` made once, and a film of other sizes by turns.
void film_size(benchmark::State& state) {
  Built& built = large_scene();
  int width = 0;
  for (auto _ : state) {
    Settings settings = bench_settings();
    settings.width += width = 1 - width;
    built.renderer.set_settings(settings);
    state.SetIterationTime(built.renderer.start(built.scene).seconds);
  }
  built.renderer.set_settings(bench_settings());
}

void whole_scene(benchmark::State& state) {
  Built& built = large_scene();
  for (auto _ : state) state.SetIterationTime(Renderer(bench_settings()).start(built.scene).seconds);
}

void move_camera(Scene& scene, double step) {
  Camera camera = scene.camera();
  camera.transform = Transform::translate({0, 0.1 * (step > 0 ? 0.01 : 0), 0}) * camera.transform.start;
  scene.set_camera(camera);
}

void change_colour(Scene& scene, double step) {
  scene.set(scene.materials().front(), Diffuse{.reflectance = {0.5, std::min(step, 1.0), 0.1}});
}

/// The emission of the first shape that emits.
void change_lamp(Scene& scene, double step) {
  static const ShapeId lamp = [&] {
    for (const ShapeId shape : scene.shapes())
      if (scene.shape(shape).emission) return shape;
    throw std::runtime_error("no shape emits");
  }();
  Shape shape = scene.shape(lamp);
  shape.emission->radiance = 10 + step;
  scene.set(lamp, shape);
}

void change_map(Scene& scene, double step) {
  constexpr int height = 512;
  const std::vector<float> texels(6 * height * height, static_cast<float>(0.1 + step));
  scene.set_environment(Pixels{.width = 2 * height, .height = height, .channels = 3, .floats = texels});
}

void move_shape(Scene& scene, double step) {
  scene.set_transform(scene.shapes().front(), Transform::translate({0, step * 1e-3, 0}));
}

void of_instances(benchmark::State& state, int triangles, const std::function<void(Scene&, double)>& change) {
  Built built(many_instances(10'000, triangles));
  measure(state, built, change);
}

void move_one(Scene& scene, double step) {
  scene.set_transform(scene.instances()[5000], Transform::translate({step, 1, 0}));
}

void move_all(Scene& scene, double step) {
  int i = 0;
  for (const InstanceId instance : scene.instances()) {
    scene.set_transform(instance, Transform::translate({i % 100 - 50.0, step, i / 100 - 50.0}));
    ++i;
  }
}

void change_point_light(Scene& scene, double step) {
  scene.set(scene.lights().front(), PointLight{500, {step, 20, 0}});
}

void change_sky(Scene& scene, double step) { scene.set_environment(Colour(step)); }

const bool is_registered = [] {
  const auto add = [](const std::string& name, const auto& run) {
    benchmark::RegisterBenchmark(("changes/" + name).c_str(), run)->Unit(benchmark::kMillisecond)->UseManualTime();
  };
  const auto add_change = [&](const std::string& name, auto* change) {
    add("scene/" + name, [change](benchmark::State& state) { of_large_scene(state, change); });
  };
  if (std::getenv("ALHAZEN_BENCH_SCENE")) {
    add("scene/everything", whole_scene);
    add_change("camera", move_camera);
    add("scene/film size", film_size);
    add_change("material", change_colour);
    add_change("emission", change_lamp);
    add_change("environment map", change_map);
    add_change("environment colour", change_sky);
    add_change("shape", move_shape);
  }
  for (const int triangles : {8, 200}) {
    const auto add_instances = [&](const std::string& name, auto* change) {
      add("instances of " + std::to_string(triangles) + " triangles/" + name,
          [=](benchmark::State& state) { of_instances(state, triangles, change); });
    };
    add_instances("one", move_one);
    add_instances("all", move_all);
    add_instances("point light", change_point_light);
    add_instances("sky", change_sky);
  }
  return true;
}();

}  // namespace
}  // namespace alhazen
