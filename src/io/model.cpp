#include "io/model.h"

#include <algorithm>
#include <utility>

#include "core/math/bounds.h"
#include "scene/default_view.h"

namespace alhazen::impl {

namespace {

bool has_faces(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) {
    Bounds3<double> box;
    for (const Vec3d& p : mesh.positions) box.extend(p);
    return !box.is_empty() && !mesh.indices.empty();
  });
}

uint32_t add_texture(Scene& scene, TextureKind kind) {
  scene.textures.emplace_back().kind = kind;
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

Material material_of_vertex_colours(Scene& scene, const Mesh& mesh) {
  Material material;
  material.reflectance = add_texture(scene, TextureKind::vertex_colour);
  if (std::any_of(mesh.colours.begin(), mesh.colours.end(), [](const auto& colour) { return colour[3] < 1; }))
    material.alpha = add_texture(scene, TextureKind::vertex_alpha);
  return material;
}

}  // namespace

void show_as_model(Scene& scene, const std::string& path, double aspect) {
  scene.name = path;
  scene.up = {0, 1, 0};
  scene.samples_per_pixel = 64;
  scene.quality = "good";
  if (!has_faces(scene)) throw InputError({path}, "the mesh has no faces, so there is no image");
  fit_camera(scene, aspect);
  add_neutral_light(scene);
}

Scene model_of(Mesh&& mesh, const std::string& path, double aspect) {
  Scene scene;
  Shape shape;
  shape.mesh = 0;
  shape.where = {path};
  if (!mesh.colours.empty()) {
    shape.material = 0;
    scene.materials.push_back(material_of_vertex_colours(scene, mesh));
  }
  scene.meshes.push_back(std::move(mesh));
  scene.groups[0].shapes.push_back(shape);
  show_as_model(scene, path, aspect);
  return scene;
}

}  // namespace alhazen::impl
