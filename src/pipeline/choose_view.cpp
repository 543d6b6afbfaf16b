#include "pipeline/choose_view.h"

#include <array>
#include <cmath>
#include <numbers>

#include "io/read_options.h"
#include "scene/default_view.h"
#include "util/diagnostics.h"

namespace alhazen {

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

/// The axes of a camera that looks along -`backward`.
ViewAxes axes_towards(const Vec3d& backward, const Vec3d& up) {
  const Vec3d right = normalize(cross(up, backward));
  return {right, cross(backward, right), backward};
}

/// Places cameras in a scene.
class CameraChoice {
 public:
  CameraChoice(const Settings& asked, Scene& scene)
      : asked_(asked), scene_(scene), camera_(scene.camera), aspect_(aspect_of(asked.width, asked.height)) {
    if (!(aspect_ > 0)) aspect_ = static_cast<double>(scene.film.width) / static_cast<double>(scene.film.height);
    const Transform& transform = camera_.world_from_camera.start;
    // glTF has right-handed axes and pbrt left-handed ones, unless a file mirrors them: what is on the right stays
    // there.
    is_mirrored_ = !transform.swaps_handedness();
    up_ = nearest_axis(column(transform, 1));
  }

  void apply() {
    check();
    if (asked_.fov) camera_.fov = *asked_.fov;
    if (!asked_.look_at.empty()) look_at();
    if (!asked_.orbit.empty()) orbit();
    if (asked_.fit) fit();
    if (asked_.aperture) camera_.lens_radius = *asked_.aperture;
    if (asked_.focus)
      camera_.focal_distance = *asked_.focus;
    else if (asked_.aperture && distance_ > 0)
      camera_.focal_distance = distance_;
  }

 private:
  void check() const {
    const bool needs_perspective =
        asked_.fov || asked_.aperture || asked_.focus || asked_.fit || asked_.orbit.size() == 2;
    if (needs_perspective && camera_.kind != CameraKind::perspective)
      throw InputError(
          "--fov, --fit, --orbit without a distance, --aperture and --focus are for perspective cameras, and the "
          "scene's "
          "is another: place it by --look-at or --orbit AZIMUTH,ELEVATION,DISTANCE");
    if (!asked_.look_at.empty() && !asked_.orbit.empty())
      throw InputError("give --look-at or --orbit, not both: each says where the camera is");
    if (asked_.fit && asked_.orbit.size() == 3)
      throw InputError("--fit chooses the distance of the camera: leave out that of --orbit");
    if (asked_.fov && (camera_.screen_window || camera_.frame_aspect_ratio))
      throw InputError(
          "--fov does not fit the scene's camera, whose screen window or frame aspect ratio says what it sees");
  }

  /// The shapes that count for the middle of the scene.
  const std::vector<PlacedShape>& shapes() {
    if (shapes_.empty()) {
      shapes_ = placed_shapes(scene_);
      leave_out_surroundings(shapes_);
    }
    return shapes_;
  }

  void place(const Vec3d& eye, const ViewAxes& axes) {
    const Vec3d right = is_mirrored_ ? -axes.right : axes.right;
    camera_.world_from_camera.start = Transform(Matrix4{{{right.x, axes.up.x, -axes.backward.x, eye.x},
                                                         {right.y, axes.up.y, -axes.backward.y, eye.y},
                                                         {right.z, axes.up.z, -axes.backward.z, eye.z},
                                                         {0, 0, 0, 1}}});
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

  /// Azimuth 0 is in front: where z is towards the viewer if y is up, as in glTF; where y is away from them if z is up.
  void orbit() {
    const double azimuth = asked_.orbit[0] * radians, elevation = asked_.orbit[1] * radians;
    const Vec3d front = up_.y != 0 ? Vec3d{0, 0, 1} : up_.z != 0 ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
    const Vec3d side = cross(up_, front), level = front * std::cos(azimuth) + side * std::sin(azimuth);
    const Vec3d backward = normalize(level * std::cos(elevation) + up_ * std::sin(elevation));
    // Seen from straight above, the front is below.
    const Vec3d up = level * -std::sin(elevation) + up_ * std::cos(elevation);
    const ViewAxes axes = axes_towards(backward, up);
    const Vec3d middle = bounds_of(shapes()).centre();
    const Vec3d eye = asked_.orbit.size() == 3 ? middle + backward * asked_.orbit[2]
                                               : fitting_eye(scene_, shapes(), aspect_, axes, camera_.fov);
    distance_ = dot(eye - middle, backward);
    place(eye, axes);
  }

  /// The camera looks where it did.
  void fit() {
    const Transform& transform = camera_.world_from_camera.start;
    const ViewAxes axes = axes_towards(normalize(-column(transform, 2)), normalize(column(transform, 1)));
    const Vec3d eye = fitting_eye(scene_, shapes(), aspect_, axes, camera_.fov);
    distance_ = dot(eye - bounds_of(shapes()).centre(), axes.backward);
    place(eye, axes);
  }

  const Settings& asked_;
  const Scene& scene_;
  Camera& camera_;
  double aspect_;
  bool is_mirrored_;
  Vec3d up_;
  double distance_ = 0;  ///< to what the camera was placed for; 0: it was not
  std::vector<PlacedShape> shapes_;
};

/// Turns maps about the upward axis of the scene, counter-clockwise seen from above.
void turn_environments(double degrees, const Vec3d& up, Scene& scene) {
  const Transform turn = Transform::rotate(degrees, up);
  for (Light& light : scene.lights)
    if (light.kind == LightKind::environment)
      light.axes = {turn.direction(light.axes.tangent), turn.direction(light.axes.bitangent),
                    turn.direction(light.axes.normal)};
}

void scale_lights(const Settings& asked, Scene& scene) {
  for (Light& light : scene.lights) {
    const bool is_infinite = light.kind == LightKind::environment || light.kind == LightKind::constant_infinite;
    light.radiance *= is_infinite ? asked.environment_strength : asked.light_scale;
  }
  for (ShapeGroup& group : scene.groups)
    for (Shape& shape : group.shapes)
      if (shape.emission) shape.emission->radiance *= asked.light_scale;
}

}  // namespace

void choose_view(const Settings& asked, Scene& scene) {
  CameraChoice(asked, scene).apply();
  if (asked.environment_rotation != 0)
    turn_environments(asked.environment_rotation, nearest_axis(column(scene.camera.world_from_camera.start, 1)), scene);
  scale_lights(asked, scene);
}

}  // namespace alhazen
