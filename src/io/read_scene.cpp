#include "io/read_scene.h"

#include <array>
#include <filesystem>
#include <fstream>

#include "core/math/bounds.h"
#include "io/gltf/gltf.h"
#include "io/images/image.h"
#include "io/pbrt/pbrt.h"
#include "io/ply/ply.h"

namespace alhazen {

namespace {

/// A mesh under a white sky, seen from the front, above and aside, so that it fills the picture.
Scene scene_around(Mesh&& mesh, const std::string& path) {
  Bounds3<double> box;
  for (const Vec3d& p : mesh.positions) box.extend(p);
  if (box.is_empty() || mesh.indices.empty()) throw InputError({path}, "the mesh has no faces, so there is no picture");
  Scene scene;
  scene.name = path;
  const double radius = std::max(0.5 * length(box.diagonal()), 1e-30);
  scene.camera.fov = 40;
  const Vec3d center = box.center();
  const Vec3d eye = center + normalize(Vec3d{0.5, 0.35, 1}) * (radius / 0.34);
  scene.camera.world_from_camera.start = Transform::look_at(eye, center, {0, 1, 0}).inverse();
  scene.camera.world_from_camera.end = scene.camera.world_from_camera.start;
  Light sky;
  sky.radiance = {1, 1, 1};
  scene.lights.push_back(sky);
  scene.meshes.push_back(std::move(mesh));
  Shape shape;
  shape.mesh = 0;
  shape.where = {path};
  scene.groups[0].shapes.push_back(shape);
  return scene;
}

std::string format_of(const std::string& path) {
  std::string extension = extension_of(path);
  if (extension == "gz") extension = extension_of(std::filesystem::path(path).stem().string());
  if (extension == "pbrt" || extension == "ply") return extension;
  if (extension == "gltf" || extension == "glb") return "gltf";
  std::array<char, 4> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  if (std::string_view(head.data(), head.size()) == "glTF") return "gltf";
  throw InputError({path},
                   "the format is not known by this name: give a .pbrt scene, a .gltf or .glb scene, or a .ply mesh "
                   "(.pbrt and .ply also as .gz)");
}

}  // namespace

Scene read_scene(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics) {
  const std::string format = format_of(path);
  if (format == "gltf") return read_gltf(path, options, diagnostics);
  if (!options.is_default())
    throw InputError({path}, "cameras, variants, animations and their time can be chosen of glTF files alone");
  if (format == "pbrt") return read_pbrt(path, diagnostics);
  return scene_around(read_ply(path, diagnostics), path);
}

SceneListing list_scene(const std::string& path, Diagnostics& diagnostics) {
  return format_of(path) == "gltf" ? list_gltf(path, diagnostics) : SceneListing{};
}

}  // namespace alhazen
