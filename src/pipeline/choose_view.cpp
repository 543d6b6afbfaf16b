#include "pipeline/choose_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "io/read_options.h"
#include "render/setting_table.h"
#include "scene/subject.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

constexpr double radians = std::numbers::pi / 180;

Vec3d column(const Transform& transform, size_t i) {
  const Matrix4& m = transform.matrix();
  return {m[0][i], m[1][i], m[2][i]};
}

/// The axis of the world, or its opposite, that is nearest to `direction`.
Vec3d nearest_axis(const Vec3d& direction) {
  const std::array<double, 3> values{direction.x, direction.y, direction.z};
  size_t largest = 0;
  for (size_t i = 1; i < 3; ++i)
    if (std::abs(values[i]) > std::abs(values[largest])) largest = i;
  std::array<double, 3> axis{};
  axis[largest] = values[largest] < 0 ? -1 : 1;
  return {axis[0], axis[1], axis[2]};
}

/// Whether the axes of the world are left-handed as the camera shows them, as in pbrt, unless a file mirrors them, and
/// unlike in glTF.
bool is_left_handed(const Camera& camera) { return !camera.world_from_camera.start.swaps_handedness(); }

/// The axes of a camera that looks along -`backward`.
ViewAxes axes_towards(const Vec3d& backward, const Vec3d& up) {
  const Vec3d right = normalize(cross(up, backward));
  return {right, cross(backward, right), backward};
}

/// Settings also come from programs, which check nothing.
void check_values(const Settings& asked) {
  for (const char* name :
       {"look-at", "orbit", "fov", "aperture", "focus", "environment-rotate", "environment-strength", "light-scale"})
    check_setting(asked, name);
}

/// Places cameras in a scene.
class CameraChoice {
 public:
  /// `camera` may be that of the scene.
  CameraChoice(const Settings& asked, const Scene& scene, Camera& camera, bool turns)
      : asked_(asked), turns_(turns), scene_(scene), camera_(camera), aspect_(aspect_of(asked.width, asked.height)) {
    if (!(aspect_ > 0)) aspect_ = static_cast<double>(scene.film.width) / static_cast<double>(scene.film.height);
    const Transform& transform = camera_.world_from_camera.start;
    is_left_handed_ = is_left_handed(camera_);
    up_ = nearest_axis(length(scene.up) > 0 ? scene.up : column(transform, 1));
    for (size_t i = 0; i < 3; ++i) scale_[i] = length(column(transform, i));
  }

  void apply() {
    check();
    if (asked_.fov) camera_.fov = *asked_.fov;
    if (!asked_.look_at.empty()) look_at();
    if (!asked_.orbit.empty()) orbit();
    // A camera that the reader has placed sees the whole scene from its side alone.
    if (asked_.fit || (turns_ && camera_.is_default && asked_.look_at.empty() && asked_.orbit.empty())) fit();
    // Lenses are in camera space.
    if (asked_.aperture) camera_.lens_radius = *asked_.aperture / scale_[0];
    if (asked_.focus)
      camera_.focal_distance = *asked_.focus / scale_[2];
    else if (camera_.lens_radius > 0 && distance_ > 0)
      camera_.focal_distance = distance_ / scale_[2];
  }

  Pivot pivot() {
    if (!subject_) subject_ = find_subject(scene_, std::nullopt);
    return {subject_->middle, up_, is_left_handed_};
  }

 private:
  void check() const {
    const bool fits = asked_.fit || asked_.orbit.size() == 2;
    if ((asked_.fov || asked_.aperture || asked_.focus || fits) && camera_.kind != CameraKind::perspective)
      throw InputError(
          "--fov, --fit, --orbit without a distance, --aperture and --focus need a perspective camera, and the scene "
          "has "
          "another: place it by --look-at or --orbit AZIMUTH,ELEVATION,DISTANCE");
    if (!asked_.look_at.empty() && !asked_.orbit.empty())
      throw InputError("give --look-at or --orbit, not both: each says where the camera is");
    if (asked_.fit && asked_.orbit.size() == 3)
      throw InputError("--fit chooses the distance of the camera: leave out that of --orbit");
    if ((asked_.fov || fits) && (camera_.screen_window || camera_.frame_aspect_ratio))
      throw InputError(
          "--fov, --fit and --orbit without a distance do not go with the scene's camera, whose screen window or frame "
          "aspect ratio says what it sees: place it by --look-at or --orbit AZIMUTH,ELEVATION,DISTANCE");
  }

  /// The position from which the whole scene is seen.
  Vec3d fitting_position(const ViewAxes& axes) {
    const ViewFrame frame = view_frame(axes, aspect_, camera_.fov);
    subject_ = find_subject(scene_, frame);
    return turns_ ? all_round_fitting_eye(scene_, *subject_, frame, up_) : fitting_eye(*subject_, frame);
  }

  /// What is on the right of the image stays there.
  void place(const Vec3d& eye, const ViewAxes& axes) {
    if (!(max_component(abs(eye)) < max_reach)) refuse_boundless(placed_shapes(scene_));
    const Vec3d right = axes.right * (is_left_handed_ ? -scale_[0] : scale_[0]), up = axes.up * scale_[1],
                forward = axes.backward * -scale_[2];
    camera_.world_from_camera.start = world_from_camera(eye, right, up, forward);
    camera_.world_from_camera.end = camera_.world_from_camera.start;
  }

  void look_at() {
    const std::vector<double>& v = asked_.look_at;
    const Vec3d eye{v[0], v[1], v[2]}, target{v[3], v[4], v[5]};
    const Vec3d up = v.size() == 9 ? Vec3d{v[6], v[7], v[8]} : up_;
    distance_ = length(eye - target);
    const Vec3d backward = distance_ > 0 ? (eye - target) / distance_ : Vec3d{};
    const double sine = length(up) > 0 ? length(cross(up / length(up), backward)) : 0;
    if (!(sine > 1e-6))
      throw InputError(
          "--look-at needs two different points, and a direction upwards, its last three numbers, that is not the one "
          "between them");
    place(eye, axes_towards(backward, up));
  }

  /// Azimuth 0 is in front, where x (or y, if x is up) is to the right.
  void orbit() {
    const double azimuth = asked_.orbit[0] * radians, elevation = asked_.orbit[1] * radians;
    const Vec3d right = up_.x != 0 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d front = cross(right, up_) * (is_left_handed_ ? -1.0 : 1.0);
    const Vec3d level = front * std::cos(azimuth) + right * std::sin(azimuth);
    const Vec3d backward = normalize(level * std::cos(elevation) + up_ * std::sin(elevation));
    // Seen from straight above, the front is below.
    const Vec3d up = level * -std::sin(elevation) + up_ * std::cos(elevation);
    const ViewAxes axes = axes_towards(backward, up);
    const Vec3d eye = asked_.orbit.size() == 3 ? pivot().middle + backward * asked_.orbit[2] : fitting_position(axes);
    distance_ = dot(eye - pivot().middle, backward);
    place(eye, axes);
  }

  /// The camera looks where it did.
  void fit() {
    const Transform& transform = camera_.world_from_camera.start;
    const ViewAxes axes = axes_towards(normalize(-column(transform, 2)), normalize(column(transform, 1)));
    const Vec3d eye = fitting_position(axes);
    distance_ = dot(eye - pivot().middle, axes.backward);
    place(eye, axes);
  }

  const Settings& asked_;
  bool turns_;  ///< about the scene, once it is placed
  const Scene& scene_;
  Camera& camera_;
  double aspect_;
  bool is_left_handed_;
  std::array<double, 3> scale_;  ///< of camera space
  Vec3d up_;
  double distance_ = 0;  ///< to what the camera was placed for; 0: it was not
  std::optional<Subject> subject_;
};

/// Turns maps about their zeniths.
void turn_environments(double degrees, Scene& scene, Diagnostics& diagnostics) {
  bool has_maps = false;
  for (Light& light : scene.lights) {
    if (light.kind != LightKind::environment) continue;
    const Transform turn = Transform::rotate(is_left_handed(scene.camera) ? -degrees : degrees, light.axes.normal);
    light.axes.tangent = turn.direction(light.axes.tangent);
    light.axes.bitangent = turn.direction(light.axes.bitangent);
    has_maps = true;
  }
  if (!has_maps) diagnostics.warn({}, "--environment-rotate has no effect: the scene has no environment map");
}

void scale_lights(const Settings& asked, Scene& scene, Diagnostics& diagnostics) {
  bool has_infinite = false, has_others = false;
  for (Light& light : scene.lights) {
    const bool is_infinite = light.kind == LightKind::environment || light.kind == LightKind::constant_infinite;
    light.radiance *= is_infinite ? asked.environment_strength : asked.light_scale;
    (is_infinite ? has_infinite : has_others) = true;
  }
  for (ShapeGroup& group : scene.groups)
    for (Shape& shape : group.shapes)
      if (shape.emission) {
        shape.emission->radiance *= asked.light_scale;
        has_others = true;
      }
  if (asked.environment_strength != 1 && !has_infinite)
    diagnostics.warn({}, "--environment-strength has no effect: the scene has no infinite light");
  if (asked.light_scale != 1 && !has_others)
    diagnostics.warn({}, "--light-scale has no effect: the scene has no other light than infinite ones");
}

}  // namespace

Camera chosen_camera(const Settings& asked, const Scene& scene, const Camera& camera) {
  check_values(asked);
  Camera chosen = camera;
  CameraChoice(asked, scene, chosen, false).apply();
  return chosen;
}

void choose_lights(const Settings& asked, Scene& scene, Diagnostics& diagnostics) {
  if (asked.environment_rotation != 0) turn_environments(asked.environment_rotation, scene, diagnostics);
  scale_lights(asked, scene, diagnostics);
}

void choose_view(const Settings& asked, Scene& scene, Diagnostics& diagnostics) {
  check_values(asked);
  CameraChoice(asked, scene, scene.camera, false).apply();
  choose_lights(asked, scene, diagnostics);
}

Pivot choose_turning_view(const Settings& asked, Scene& scene, Diagnostics& diagnostics) {
  check_values(asked);
  CameraChoice choice(asked, scene, scene.camera, true);
  choice.apply();
  choose_lights(asked, scene, diagnostics);
  return choice.pivot();
}

Camera placed_camera(const Settings& asked, const Camera& camera, Scene& scene) {
  scene.camera = camera;
  CameraChoice(asked, scene, scene.camera, false).apply();
  return scene.camera;
}

Camera turned_camera(const Camera& camera, const Pivot& pivot, double degrees) {
  if (degrees == 0) return camera;
  const Transform turn = Transform::translate(pivot.middle) *
                         Transform::rotate(pivot.is_left_handed ? -degrees : degrees, pivot.up) *
                         Transform::translate(-pivot.middle);
  Camera turned = camera;
  turned.world_from_camera = {turn * camera.world_from_camera.start, turn * camera.world_from_camera.end};
  return turned;
}

}  // namespace alhazen::impl
