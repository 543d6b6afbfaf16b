#include <algorithm>
#include <numbers>

#include "io/gltf/cameras_and_lights.h"
#include "util/numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// glTF's cameras look along -z; here z points into the scene. Their scale is ignored.
Transform world_from_camera(const Document& document, const Json& place, const Matrix4& node) {
  const Vec3d x = column(node, 0), y = column(node, 1), z = column(node, 2);
  if (!(length(x) > 0 && length(y) > 0 && length(z) > 0))
    document.fail(place, "the node of the camera is scaled to nothing");
  // Orthonormalized, with the viewing direction unchanged.
  const Vec3d forward = -normalize(z);
  const Vec3d side = cross(forward, y);
  if (!(length(side) > 0)) document.fail(place, "the node of the camera is sheared to nothing");
  const Vec3d right = normalize(side), up = cross(right, forward);
  const double mirror = dot(right, x) < 0 ? -1 : 1;
  return Transform(Matrix4{{{mirror * right.x, up.x, forward.x, node[0][3]},
                            {mirror * right.y, up.y, forward.y, node[1][3]},
                            {mirror * right.z, up.z, forward.z, node[2][3]},
                            {0, 0, 0, 1}}});
}

/// The longer side of the image is 1280 pixels if the camera has an aspect ratio.
void set_film(double aspect, FilmSettings& film) {
  const double side = 1280;
  film.width = std::max<int64_t>(1, std::lround(aspect >= 1 ? side : side * aspect));
  film.height = std::max<int64_t>(1, std::lround(aspect >= 1 ? side / aspect : side));
}

void set_perspective(const Document& document, const Json& description, Scene& scene) {
  const double yfov = document.number(description, "yfov", 0), aspect = document.number(description, "aspectRatio", 0);
  if (!(yfov > 0 && yfov < std::numbers::pi))
    document.fail(description, "\"yfov\" must be above 0 and below pi radians");
  if (!(aspect >= 0 && aspect < 1e4 && (aspect == 0 || aspect > 1e-4)))
    document.fail(description, "\"aspectRatio\" must be above 0");
  if (aspect > 0) set_film(aspect, scene.film);
  // The field of view is given over the shorter axis.
  const double shorter = aspect > 0 && aspect < 1 ? 2 * std::atan(std::tan(yfov / 2) * aspect) : yfov;
  scene.camera.fov = shorter * degrees;
}

void set_orthographic(const Document& document, const Json& description, Scene& scene) {
  const double x = std::abs(document.number(description, "xmag", 0));
  const double y = std::abs(document.number(description, "ymag", 0));
  if (!(x > 0 && y > 0 && x < 1e9 * y && y < 1e9 * x))
    document.fail(description, "\"xmag\" and \"ymag\" must be above 0");
  scene.camera.kind = CameraKind::orthographic;
  // Uses the camera's scale instead of a window, so that images with another aspect ratio are not stretched.
  scene.camera.world_from_camera.start = Transform::scale(splat(std::min(x, y)));
  if (x / y < 1e4 && y / x < 1e4) set_film(x / y, scene.film);
}

bool is_number_of(const std::string& text, size_t count, size_t& number) {
  const std::optional<int64_t> value = parse_integer(text);
  if (!value || *value < 0 || static_cast<uint64_t>(*value) >= count) return false;
  number = static_cast<size_t>(*value);
  return true;
}

}  // namespace

size_t choose(const Document& document, const std::string& choice, const std::vector<std::string>& names,
              const char* what) {
  const auto entry = std::find(names.begin(), names.end(), choice);
  if (entry != names.end()) return static_cast<size_t>(entry - names.begin());
  size_t number = 0;
  if (is_number_of(choice, names.size(), number)) return number;
  std::string known;
  for (size_t i = 0; i < names.size() && i < 16; ++i)
    known += (i == 0 ? "" : ", ") + std::to_string(i) + (names[i].empty() ? "" : " " + quoted(names[i]));
  throw InputError({document.path()}, std::string("there is no ") + what + " " + quoted(choice) +
                                          (names.empty() ? "; the file has none" : "; it may be one of " + known));
}

std::vector<CameraNode> camera_nodes(const Document& document, const Nodes& nodes) {
  std::vector<CameraNode> cameras;
  for (const uint32_t node : nodes.of_scene()) {
    const Json& description = document.item("nodes", node);
    const auto camera = document.index(description, "camera", "cameras");
    if (!camera) continue;
    std::string name = document.string(description, "name");
    if (name.empty()) name = document.string(document.item("cameras", *camera), "name");
    cameras.push_back({node, *camera, name});
  }
  return cameras;
}

bool set_camera(const Document& document, const Nodes& nodes, const std::string& choice, Scene& scene) {
  const std::vector<CameraNode> cameras = camera_nodes(document, nodes);
  if (cameras.empty() && choice.empty()) return false;
  std::vector<std::string> names;
  for (const CameraNode& camera : cameras) names.push_back(camera.name);
  const CameraNode& chosen = cameras[choice.empty() ? 0 : choose(document, choice, names, "camera")];
  const Json& description = document.item("cameras", chosen.camera);
  const std::string type = document.string(description, "type");
  if (type != "perspective" && type != "orthographic")
    document.fail(description, "unknown \"type\" of a camera: it may be perspective or orthographic");
  const Json* lens = document.object(description, type.c_str());
  if (lens == nullptr) document.fail(description, "the camera has no \"" + type + "\"");
  const double nearest = document.number(*lens, "znear", 0), farthest = document.number(*lens, "zfar", 0);
  if (nearest < 0 || farthest < 0) document.fail(*lens, "\"znear\" and \"zfar\" must not be negative");
  if (type == "perspective")
    set_perspective(document, *lens, scene);
  else
    set_orthographic(document, *lens, scene);
  scene.camera.world_from_camera.start =
      world_from_camera(document, document.item("nodes", chosen.node), nodes.world(chosen.node)) *
      scene.camera.world_from_camera.start;
  scene.camera.world_from_camera.end = scene.camera.world_from_camera.start;
  return true;
}

}  // namespace alhazen::impl::gltf
