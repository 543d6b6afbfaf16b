#include "scene/default_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/lights/sphere_mapping.h"

namespace alhazen {

namespace {

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Calls visit(point) for points in world space between which the shape is: the vertices of a mesh, the corners of a
/// box about others.
template <class Visit>
void for_each_point(const Scene& scene, const PlacedShape& placed, const Visit& visit) {
  const Shape& shape = *placed.shape;
  if (shape.type == ShapeType::mesh) {
    for (const Vec3d& p : scene.meshes[shape.mesh].positions) visit(placed.world_from_object.point(p));
    return;
  }
  const Vec3d reach = shape.reach();
  for (int corner = 0; corner < 8; ++corner)
    visit(placed.world_from_object.point(
        {corner & 1 ? reach.x : -reach.x, corner & 2 ? reach.y : -reach.y, corner & 4 ? reach.z : -reach.z}));
}

/// From the centre of a box to the camera. glTF models face +z. A model that is flat in z, such as a sign, is seen from
/// the front, others more from the side and from above; one that is long in z is seen from its side, and one that is
/// flat in y from above.
Vec3d direction_to_eye(const Vec3d& half) {
  const auto ratio = [](double a, double b) { return b > 0 ? std::clamp(a / b, 0.0, 1.0) : 1.0; };
  const double depth = ratio(1.5 * half.z, std::max(half.x, half.y));
  const double length_in_z = 1 - ratio(half.x, half.z), flatness = 1 - ratio(half.y, std::max(half.x, half.z));
  return normalize(Vec3d{0.12 + 0.33 * depth + 0.5 * length_in_z, 0.08 + 0.3 * depth + 0.2 * depth * flatness, 1});
}

}  // namespace

std::vector<PlacedShape> placed_shapes(const Scene& scene) {
  std::vector<PlacedShape> shapes;
  const auto add = [&](const Shape& shape, const Transform& world_from_object) {
    PlacedShape placed{&shape, world_from_object, {}};
    for_each_point(scene, placed, [&](const Vec3d& p) { placed.box.extend(p); });
    if (!placed.box.is_empty()) shapes.push_back(placed);
  };
  for (const Shape& shape : scene.groups[0].shapes) add(shape, shape.world_from_object.start);
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.groups[instance.group].shapes)
      add(shape, instance.world_from_group.start * shape.world_from_object.start);
  return shapes;
}

void leave_out_surroundings(std::vector<PlacedShape>& shapes) {
  constexpr double surroundings = 30;
  const auto size = [](const PlacedShape& placed) { return length(placed.box.diagonal()); };
  std::stable_sort(shapes.begin(), shapes.end(),
                   [&](const PlacedShape& a, const PlacedShape& b) { return size(a) < size(b); });
  Bounds3<double> smaller;
  for (size_t i = 0; i + 1 < shapes.size(); ++i) {
    smaller.extend(shapes[i].box);
    if (size(shapes[i + 1]) > surroundings * length(smaller.diagonal()) && length(smaller.diagonal()) > 0 &&
        i + 1 >= shapes.size() / 2) {
      shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(i) + 1, shapes.end());
      return;
    }
  }
}

Bounds3<double> bounds_of(const std::vector<PlacedShape>& shapes) {
  Bounds3<double> box;
  for (const PlacedShape& placed : shapes) box.extend(placed.box);
  if (box.is_empty()) box.extend(Vec3d{});
  return box;
}

Vec3d fitting_eye(const Scene& scene, const std::vector<PlacedShape>& shapes, double aspect, const ViewAxes& axes,
                  double fov) {
  const Bounds3<double> box = bounds_of(shapes);
  const Vec3d centre = box.centre(), half = box.diagonal() * 0.5;
  const double tangent = std::tan(fov / 2 * std::numbers::pi / 180) / 1.08;
  const double across = tangent * std::max(aspect, 1.0), along = tangent / std::min(aspect, 1.0);
  // A point is visible if |x - eye.x| <= tangent * (distance - z), in coordinates along right, up and backward. So the
  // largest x + tangent * z and the largest -x + tangent * z of all points determine the eye's position between them
  // and its distance.
  double to_right = -1e300, to_left = -1e300, to_top = -1e300, to_bottom = -1e300, nearest = -1e300;
  const auto visit = [&](const Vec3d& point) {
    const Vec3d p = point - centre;
    const double x = dot(p, axes.right), y = dot(p, axes.up), z = dot(p, axes.backward);
    to_right = std::max(to_right, x + across * z), to_left = std::max(to_left, -x + across * z);
    to_top = std::max(to_top, y + along * z), to_bottom = std::max(to_bottom, -y + along * z);
    nearest = std::max(nearest, z);
  };
  for (const PlacedShape& placed : shapes) for_each_point(scene, placed, visit);
  if (nearest == -1e300) visit(centre);
  // If the scene is a single point, any distance will do.
  const double size = length(half) > 0 ? length(half) : 1e-6;
  const double distance =
      std::max({(to_right + to_left) / (2 * across), (to_top + to_bottom) / (2 * along), nearest + size * 1e-3});
  return centre + axes.right * ((to_right - to_left) / 2) + axes.up * ((to_top - to_bottom) / 2) +
         axes.backward * distance;
}

Transform world_from_camera(const Vec3d& eye, const Vec3d& right, const Vec3d& up, const Vec3d& forward) {
  return Transform(Matrix4{{{right.x, up.x, forward.x, eye.x},
                            {right.y, up.y, forward.y, eye.y},
                            {right.z, up.z, forward.z, eye.z},
                            {0, 0, 0, 1}}});
}

void fit_camera(Scene& scene, double aspect) {
  if (!(aspect > 0)) aspect = static_cast<double>(scene.film.width) / static_cast<double>(scene.film.height);
  const std::vector<PlacedShape> shapes = placed_shapes(scene);
  const Vec3d backward = direction_to_eye(bounds_of(shapes).diagonal() * 0.5);
  const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, backward)), up = cross(backward, right);
  scene.camera.fov = 40;
  const Vec3d eye = fitting_eye(scene, shapes, aspect, {right, up, backward}, scene.camera.fov);
  scene.camera.world_from_camera.start = world_from_camera(eye, right, up, -backward);
  scene.camera.world_from_camera.end = scene.camera.world_from_camera.start;
}

void add_neutral_light(Scene& scene) {
  ImageTexels map;
  map.width = 128;
  map.height = 64;
  map.srgb = false;
  map.name = "the neutral light";
  // In front of and above the model, beside it, and behind: key light, fill light and rim light.
  struct Window {
    Vec3d direction;
    double cosine, brightness;  ///< cosine at the edge; brightness at the centre
  };
  const std::array<Window, 3> windows{Window{normalize(Vec3d{-0.5, 0.8, 0.7}), 0.94, 7},
                                      Window{normalize(Vec3d{0.95, 0.2, 0.2}), 0.92, 1.5},
                                      Window{normalize(Vec3d{0.85, 0.6, -0.55}), 0.93, 2}};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      // The map's z is up in world space.
      const Vec3d d =
          direction_of_square(SphereMapping::equirectangular, Vec2d{(x + 0.5) / map.width, (y + 0.5) / map.height});
      const Vec3d world{d.x, d.z, -d.y};
      double sky = 0.16 + 0.36 * smoothstep(-0.8, 0.9, world.y);
      for (const Window& w : windows)
        sky += w.brightness * smoothstep(w.cosine, w.cosine + 0.03, dot(world, w.direction));
      for (int c = 0; c < 3; ++c) map.floats.push_back(static_cast<float>(sky));
    }
  Light light;
  light.kind = LightKind::environment;
  light.radiance = {1, 1, 1};
  light.environment = static_cast<uint32_t>(scene.environments.size());
  // The axes x, y, z of the map in world space: a rotation that takes z to y.
  light.axes = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  light.where = {scene.name};
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(light);
}

}  // namespace alhazen
