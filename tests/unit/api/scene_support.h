#pragma once

// Scenes that are made in memory beside the texts of pbrt files that say the same.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "alhazen/scene.h"
#include "support/temporary_folder.h"

namespace alhazen::test {

using Planes = std::vector<std::vector<float>>;

inline Settings quick_settings() {
  Settings settings;
  settings.width = 20;
  settings.height = 14;
  settings.samples_per_pixel = 4;
  settings.max_depth = 4;
  settings.backend = "serial";
  return settings;
}

inline Planes rendered(const Scene& scene, const Settings& settings = quick_settings()) {
  return render(scene, settings).planes;
}

/// Where every test scene is seen from, as pbrt sees it.
inline constexpr const char* pbrt_view = "LookAt 0 1 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n";

inline Camera view_of_pbrt() {
  Camera camera;
  camera.transform = Transform::look_at({0, 1, -4}, {0, 0, 0}, {0, 1, 0}, Handedness::left);
  camera.fov = 40;
  return camera;
}

inline constexpr std::array<float, 12> floor_positions{-3, -1, -3, -3, -1, 3, 3, -1, 3, 3, -1, -3};
inline constexpr std::array<uint32_t, 6> floor_indices{0, 1, 2, 0, 2, 3};
inline constexpr std::array<float, 8> floor_uvs{0, 0, 0, 2, 2, 2, 2, 0};

/// The floor in the current material.
inline constexpr const char* pbrt_floor =
    "Shape \"trianglemesh\" \"point3 P\" [-3 -1 -3  -3 -1 3  3 -1 3  3 -1 -3] \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point2 uv\" [0 0  0 2  2 2  2 0]\n";

inline MeshId add_floor(Scene& scene, MaterialId material = {}) {
  const MeshId mesh = scene.add(MeshArrays{.positions = std::span<const float>(floor_positions),
                                           .indices = floor_indices,
                                           .uvs = std::span<const float>(floor_uvs)});
  scene.add(Shape{mesh, material});
  return mesh;
}

/// A point light and a sky.
inline constexpr const char* pbrt_lights =
    "LightSource \"point\" \"rgb I\" [10 9 8] \"point3 from\" [1 3 -2]\n"
    "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]\n";

inline void add_lights(Scene& scene) {
  scene.add(PointLight{{10, 9, 8}, {1, 3, -2}});
  scene.set_environment(Colour{0.4, 0.5, 0.6});
}

/// A scene with one or more parts of each kind.
struct Sample {
  Scene scene;
  MeshId mesh;
  ImageId image;
  TextureId texture;
  MaterialId clay, glass;
  ShapeId floor, ball, part;
  GroupId group;
  InstanceId instance;
  LightId lamp, sky;

  Sample() {
    scene.set_camera(view_of_pbrt());
    clay = scene.add(Material(Diffuse{.reflectance = {0.8, 0.4, 0.2}}, "clay"));
    glass = scene.add(Material(Dielectric{}, "glass"));
    mesh = scene.add(MeshArrays{.positions = std::span<const float>(floor_positions),
                                .indices = floor_indices,
                                .uvs = std::span<const float>(floor_uvs),
                                .name = "plane"});
    image = scene.add(
        Pixels{.width = 2, .height = 1, .channels = 1, .bytes = std::vector<uint8_t>{10, 200}, .name = "grey"});
    texture = scene.add(Texture(ImageTexture{.image = image}, "paint"));
    floor = scene.add(Shape{.geometry = mesh, .material = clay, .name = "ground"});
    ball = scene.add(Shape{Sphere{0.5}, glass});
    group = scene.add_group("pair");
    part = scene.add(Shape{Sphere{0.2}, clay}, group);
    instance = scene.add(Instance{.group = group, .transform = Transform::translate({1, 0, 0})});
    lamp = scene.add(Light(PointLight{{10, 9, 8}, {1, 3, -2}}, "lamp"));
    sky = scene.set_environment(Colour(0.3));
  }
};

/// Renders text as a pbrt file.
class SceneTest : public ::testing::Test {
 protected:
  Planes rendered_text(const std::string& text, const Settings& settings = quick_settings()) const {
    return render(folder_.write_text("scene.pbrt", text), settings).planes;
  }

  impl::test::TemporaryFolder folder_;
};

/// The message of the InputError that `work` throws; fails if it throws none.
template <class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace alhazen::test
