#include "view/view_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alhazen::impl {

namespace {

Vec3 sum(const Vec3& a, const Vec3& b, double factor) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vec3& v) { return std::hypot(v.x, v.y, v.z); }
Vec3 scaled(const Vec3& v, double factor) { return {v.x * factor, v.y * factor, v.z * factor}; }
Vec3 unit(const Vec3& v) { return scaled(v, 1 / length(v)); }

/// Without a roll, the camera is upright: its x axis is level.
bool is_upright(const Vec3& right, const Vec3& above, const Vec3& up) {
  return std::abs(dot(right, up)) < 1e-6 && dot(above, up) > 1e-3;
}

}  // namespace

SceneExtent extent_of(const Box& bounds, const Vec3& up) {
  SceneExtent extent;
  if (length(up) > 0) extent.up = unit(up);
  if (bounds.is_empty()) return extent;
  extent.middle = scaled(sum(bounds.low, bounds.high, 1), 0.5);
  const double radius = 0.5 * length(sum(bounds.high, bounds.low, -1));
  if (radius > 0 && std::isfinite(radius)) extent.radius = radius;
  return extent;
}

bool is_left_handed(const Camera& camera) {
  const Transform& t = camera.transform.start;
  const Vec3 x = t.direction({1, 0, 0}), y = t.direction({0, 1, 0}), z = t.direction({0, 0, 1});
  const Vec3 cross{x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
  return dot(cross, z) > 0;  // z points into the scene
}

PageCamera page_camera(const Camera& camera, const SceneExtent& extent) {
  const Transform& t = camera.transform.start;
  const Vec3 forward = t.direction({0, 0, 1}), right = unit(t.direction({1, 0, 0})),
             above = unit(t.direction({0, 1, 0}));
  const double scale = length(forward);
  PageCamera page;
  page.position = t.point({0, 0, 0});
  page.aperture = camera.lens_radius * scale;
  const bool is_perspective = camera.kind == CameraKind::perspective;
  if (is_perspective) page.fov = camera.fov;
  double distance = dot(sum(extent.middle, page.position, -1), unit(forward));
  if (camera.lens_radius > 0) {
    page.focus = camera.focal_distance * scale;
    distance = *page.focus;
  }
  // Something to turn about, also where the camera looks away from the scene.
  distance = std::clamp(distance, 0.02 * extent.radius, 100 * extent.radius);
  page.target = sum(page.position, unit(forward), distance);
  page.up = is_upright(right, above, extent.up) ? extent.up : above;
  return page;
}

Camera placed_camera(const Camera& base, const PageCamera& wanted) {
  Camera camera = base;
  camera.transform = Transform::look_at(wanted.position, wanted.target, wanted.up,
                                        is_left_handed(base) ? Handedness::left : Handedness::right);
  if (wanted.fov && camera.kind == CameraKind::perspective) camera.fov = *wanted.fov;
  camera.lens_radius = wanted.aperture;
  if (wanted.aperture > 0)
    camera.focal_distance = wanted.focus.value_or(length(sum(wanted.target, wanted.position, -1)));
  return camera;
}

Camera coarse_camera(const Camera& camera, int full_width, int full_height, const PixelRegion& region, int step) {
  if (camera.kind != CameraKind::perspective && camera.kind != CameraKind::orthographic) return camera;
  const double width = full_width, height = full_height;
  const double aspect = camera.frame_aspect_ratio.value_or(width / height);
  const std::array<double, 4> whole = camera.screen_window.value_or(
      aspect > 1 ? std::array{-aspect, aspect, -1.0, 1.0} : std::array{-1.0, 1.0, -1 / aspect, 1 / aspect});
  const auto coarse = [&](int size) { return static_cast<double>((size + step - 1) / step * step); };
  const double x_scale = (whole[1] - whole[0]) / width, y_scale = (whole[3] - whole[2]) / height;
  const double left = whole[0] + region.x * x_scale, top = whole[3] - region.y * y_scale;
  Camera seen = camera;
  seen.screen_window = {left, left + coarse(region.width) * x_scale, top - coarse(region.height) * y_scale, top};
  return seen;
}

std::string camera_options(const PageCamera& camera) {
  const Vec3 &position = camera.position, &target = camera.target, &up = camera.up;
  std::string text = fmt::format("--look-at {},{},{},{},{},{},{},{},{}", position.x, position.y, position.z, target.x,
                                 target.y, target.z, up.x, up.y, up.z);
  if (camera.fov) text += fmt::format(" --fov {}", *camera.fov);
  // Zero replaces the lens that the file's camera may have.
  text += fmt::format(" --aperture {}", camera.aperture);
  if (camera.aperture > 0 && camera.focus) text += fmt::format(" --focus {}", *camera.focus);
  return text;
}

}  // namespace alhazen::impl
