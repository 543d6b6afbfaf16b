#include "scene/default_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/lights/sphere_mapping.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
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
  for_each_placed_shape(scene, [&](const Shape& shape, const Transform& world_from_object) {
    PlacedShape placed{&shape, world_from_object, {}};
    for_each_point(scene, shape, world_from_object, [&](const Vec3d& p) { placed.box.extend(p); });
    if (!placed.box.is_empty()) shapes.push_back(placed);
  });
  return shapes;
}

Bounds3<double> bounds_of(const std::vector<PlacedShape>& shapes) {
  Bounds3<double> box;
  for (const PlacedShape& placed : shapes) box.extend(placed.box);
  if (box.is_empty()) box.extend(Vec3d{});
  return box;
}

ViewFrame view_frame(const ViewAxes& axes, double aspect, double fov) {
  constexpr double margin = 1.08;
  const double tangent = std::tan(fov / 2 * std::numbers::pi / 180) / margin;
  return {axes, tangent * std::max(aspect, 1.0), tangent / std::min(aspect, 1.0)};
}

void ViewReach::add(const ViewFrame& frame, const Vec3d& p) {
  const double x = dot(p, frame.axes.right), y = dot(p, frame.axes.up), z = dot(p, frame.axes.backward);
  to_right = std::max(to_right, x + frame.across * z), to_left = std::max(to_left, -x + frame.across * z);
  to_top = std::max(to_top, y + frame.along * z), to_bottom = std::max(to_bottom, -y + frame.along * z);
  nearest = std::max(nearest, z);
}

/// What is to be maximised is linear in the position; of a circle it is the value at its centre plus the radius times
/// the length of what the gradient has in the plane of the circle.
void ViewReach::add_all_round(const ViewFrame& frame, const Vec3d& p, const Vec3d& up) {
  const double height = dot(p, up), radius = length(p - up * height);
  const auto largest = [&](const Vec3d& gradient) {
    const double along_axis = dot(gradient, up);
    return height * along_axis + radius * length(gradient - up * along_axis);
  };
  const ViewAxes& axes = frame.axes;
  to_right = std::max(to_right, largest(axes.right + axes.backward * frame.across));
  to_left = std::max(to_left, largest(-axes.right + axes.backward * frame.across));
  to_top = std::max(to_top, largest(axes.up + axes.backward * frame.along));
  to_bottom = std::max(to_bottom, largest(-axes.up + axes.backward * frame.along));
  nearest = std::max(nearest, largest(axes.backward));
}

void ViewReach::add(const ViewReach& other) {
  to_right = std::max(to_right, other.to_right), to_left = std::max(to_left, other.to_left);
  to_top = std::max(to_top, other.to_top), to_bottom = std::max(to_bottom, other.to_bottom);
  nearest = std::max(nearest, other.nearest);
}

Vec3d ViewReach::eye(const ViewFrame& frame, double min_distance) const {
  const double distance = std::max(
      {(to_right + to_left) / (2 * frame.across), (to_top + to_bottom) / (2 * frame.along), nearest + min_distance});
  return frame.axes.right * ((to_right - to_left) / 2) + frame.axes.up * ((to_top - to_bottom) / 2) +
         frame.axes.backward * distance;
}

Vec3d fitting_eye(const Scene& scene, const std::vector<PlacedShape>& shapes, double aspect, const ViewAxes& axes,
                  double fov) {
  const Bounds3<double> box = bounds_of(shapes);
  const Vec3d centre = box.centre(), half = box.diagonal() * 0.5;
  const ViewFrame frame = view_frame(axes, aspect, fov);
  ViewReach reach;
  const auto visit = [&](const Vec3d& point) { reach.add(frame, point - centre); };
  for (const PlacedShape& placed : shapes) for_each_point(scene, *placed.shape, placed.world_from_object, visit);
  if (reach.nearest == -1e300) visit(centre);
  // If the scene is a single point, any distance will do.
  const double size = length(half) > 0 ? length(half) : 1e-6;
  return centre + reach.eye(frame, size * 1e-3);
}

Transform world_from_camera(const Vec3d& eye, const Vec3d& right, const Vec3d& up, const Vec3d& forward) {
  const Matrix4 matrix{{{right.x, up.x, forward.x, eye.x},
                        {right.y, up.y, forward.y, eye.y},
                        {right.z, up.z, forward.z, eye.z},
                        {0, 0, 0, 1}}};
  try {
    if (is_finite(eye)) return Transform(matrix);
  } catch (const std::domain_error&) {
    // said below
  }
  throw InputError(
      "no camera can be placed there: what it is to see, or where it is to be, exceeds double precision; scale the "
      "scene down");
}

void refuse_boundless(const std::vector<PlacedShape>& shapes) {
  for (const PlacedShape& placed : shapes)
    if (!(max_component(abs(placed.box.low)) < max_reach && max_component(abs(placed.box.high)) < max_reach))
      throw InputError(
          placed.shape->where,
          "the shape reaches farther than 1e18, which is too far for ray tracing: scale it, or its transform, down");
}

Camera fitted_camera(const Scene& scene, double aspect) {
  if (!(aspect > 0)) aspect = static_cast<double>(scene.film.width) / static_cast<double>(scene.film.height);
  const std::vector<PlacedShape> shapes = placed_shapes(scene);
  refuse_boundless(shapes);
  const Vec3d backward = direction_to_eye(bounds_of(shapes).diagonal() * 0.5);
  const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, backward)), up = cross(backward, right);
  Camera camera = scene.camera;
  camera.fov = 40;
  const Vec3d eye = fitting_eye(scene, shapes, aspect, {right, up, backward}, camera.fov);
  camera.world_from_camera.start = world_from_camera(eye, right, up, -backward);
  camera.world_from_camera.end = camera.world_from_camera.start;
  camera.is_default = true;
  return camera;
}

void fit_camera(Scene& scene, double aspect) { scene.camera = fitted_camera(scene, aspect); }

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

}  // namespace alhazen::impl
