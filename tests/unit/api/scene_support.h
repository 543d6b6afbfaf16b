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
