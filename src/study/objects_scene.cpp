#include "study/objects_scene.h"

#include <cmath>
#include <random>

namespace alhazen::impl::study {

namespace {

/// Radius of a single sphere in the cube from -1 to 1, for which the mean free path is about the cube's edge, or a
/// twelfth of it for dense clouds.
constexpr double radius_of_one = 1.2, dense_radius_of_one = 4;

}  // namespace

Scene cloud_of_spheres(uint64_t count, bool is_glass) {
  Scene scene;
  scene.name = std::to_string(count) + " spheres";
  scene.film.width = scene.film.height = 400;
  scene.integrator = IntegratorKind::iterative;
  scene.max_depth = 9;
  const Transform camera = Transform::look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}).inverse();
  scene.camera.world_from_camera = {camera, camera};
  scene.camera.fov = 24;
  Texture grey;
  grey.name = "grey";
  grey.value = {0.7, 0.7, 0.7};
  scene.textures.push_back(grey);
  Material material;
  material.kind = is_glass ? MaterialKind::dielectric : MaterialKind::diffuse;
  if (!is_glass) material.reflectance = 0;
  scene.materials.push_back(material);
  Light sky;
  sky.radiance = {1, 1, 1};
  scene.lights.push_back(sky);

  std::mt19937_64 random(count);
  const auto between_minus_one_and_one = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const double radius = (is_glass ? dense_radius_of_one : radius_of_one) / std::sqrt(static_cast<double>(count));
  std::vector<Shape>& shapes = scene.groups[0].shapes;
  shapes.reserve(count);
  for (uint64_t i = 0; i < count; ++i) {
    Shape sphere;
    sphere.type = ShapeType::sphere;
    sphere.radius = radius;
    sphere.material = 0;
    const double x = between_minus_one_and_one(), y = between_minus_one_and_one(), z = between_minus_one_and_one();
    const Transform place = Transform::translate({x, y, z});
    sphere.world_from_object = {place, place};
    shapes.push_back(std::move(sphere));
  }
  return scene;
}

}  // namespace alhazen::impl::study
