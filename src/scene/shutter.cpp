#include "scene/shutter.h"

#include <algorithm>

namespace alhazen::impl {

namespace {

bool has_motion(const Scene& scene) {
  const auto moves = [](const Shape& shape) { return shape.world_from_object.is_moving(); };
  return scene.camera.world_from_camera.is_moving() ||
         std::any_of(
             scene.groups.begin(), scene.groups.end(),
             [&](const ShapeGroup& group) { return std::any_of(group.shapes.begin(), group.shapes.end(), moves); }) ||
         std::any_of(scene.instances.begin(), scene.instances.end(),
                     [](const Instance& instance) { return instance.world_from_group.is_moving(); });
}

/// The position moves along a line; the axes are interpolated and made perpendicular again, with the direction of view
/// as it is.
Transform camera_between(const MovingTransform& camera, double s) {
  if (s <= 0) return camera.start;
  if (s >= 1) return camera.end;
  const Matrix4 &a = camera.start.matrix(), &b = camera.end.matrix();
  const auto mixed = [&](size_t column) {
    const auto of = [&](const Matrix4& m) { return Vec3d{m[0][column], m[1][column], m[2][column]}; };
    return of(a) * (1 - s) + of(b) * s;
  };
  const auto size = [&](size_t column) {
    const auto of = [&](const Matrix4& m) { return length(Vec3d{m[0][column], m[1][column], m[2][column]}); };
    return of(a) * (1 - s) + of(b) * s;
  };
  const Vec3d forward = mixed(2), side = cross(mixed(1), forward);
  if (!(length(forward) > 0 && length(side) > 0)) throw InputError("the camera turns over while it moves");
  const Vec3d z = normalize(forward), x = normalize(side) * (camera.start.swaps_handedness() ? -1.0 : 1.0);
  const Vec3d y = cross(z, normalize(side)), right = x * size(0), up = y * size(1), view = z * size(2), eye = mixed(3);
  return Transform(Matrix4{
      {{right.x, up.x, view.x, eye.x}, {right.y, up.y, view.y, eye.y}, {right.z, up.z, view.z, eye.z}, {0, 0, 0, 1}}});
}

}  // namespace

void set_shutter(Scene& scene, std::optional<double> time, std::optional<double> seconds) {
  Camera& camera = scene.camera;
  if (time && !has_motion(scene))
    throw InputError({scene.name},
                     "nothing in the scene moves, so it is the same at all times: leave out --time and --frames; "
                     "--turntable turns the camera about it");
  const double open_for = seconds.value_or(camera.shutter_close - camera.shutter_open);
  if (time) camera.shutter_open = *time;
  camera.shutter_close = camera.shutter_open + open_for;
  const double span = scene.transform_end_time - scene.transform_start_time;
  MovingTransform& placed = camera.world_from_camera;
  if (!time || !placed.is_moving() || !(span > 0)) return;
  const auto at = [&](double when) { return camera_between(placed, (when - scene.transform_start_time) / span); };
  placed = {at(camera.shutter_open), at(camera.shutter_close)};
}

}  // namespace alhazen::impl
