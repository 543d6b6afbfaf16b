#pragma once

// Cameras and lights for scenes, or models, that have none.

#include <vector>

#include "core/math/bounds.h"
#include "scene/scene.h"
#include "scene/transform.h"

namespace alhazen::impl {

/// A shape where it is at the start of its motion.
struct PlacedShape {
  const Shape* shape;
  Transform world_from_object;
  Bounds3<double> box;  ///< in world space; of shapes other than meshes it may be larger than needed
};

/// All shapes, also those of instances. They point into `scene`.
std::vector<PlacedShape> placed_shapes(const Scene& scene);

/// Of the origin if there are none.
Bounds3<double> bounds_of(const std::vector<PlacedShape>& shapes);

/// Coordinates beyond it are too large for ray tracing: their squares would be out of the range of float.
inline constexpr double max_reach = 1e18;

/// Throws InputError if a shape reaches beyond max_reach, so that no camera can be placed for it.
void refuse_boundless(const std::vector<PlacedShape>& shapes);

/// The scene's camera, placed where it sees the whole scene from the front, the side and above, for an image of that
/// aspect ratio (width over height; 0: that of the film). The scene's y is up.
Camera fitted_camera(const Scene& scene, double aspect);

/// Makes it the scene's.
void fit_camera(Scene& scene, double aspect);

/// Calls visit(point) for points in world space between which the shape is: the vertices of a mesh, the corners of a
/// box about others.
template <class Visit>
void for_each_point(const Scene& scene, const Shape& shape, const Transform& world_from_object, const Visit& visit) {
  if (shape.type == ShapeType::mesh) {
    for (const Vec3d& p : scene.meshes[shape.mesh].positions) visit(world_from_object.point(p));
    return;
  }
  const Vec3d reach = shape.reach();
  for (int corner = 0; corner < 8; ++corner)
    visit(world_from_object.point(
        {corner & 1 ? reach.x : -reach.x, corner & 2 ? reach.y : -reach.y, corner & 4 ? reach.z : -reach.z}));
}

/// Calls visit(shape, world_from_object) for every shape, also those of instances, at the start of its motion.
template <class Visit>
void for_each_placed_shape(const Scene& scene, const Visit& visit) {
  for (const Shape& shape : scene.groups[0].shapes) visit(shape, shape.world_from_object.start);
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.groups[instance.group].shapes)
      visit(shape, instance.world_from_group.start * shape.world_from_object.start);
}

/// Where the camera is and where it looks. All are of unit length and perpendicular to each other.
struct ViewAxes {
  Vec3d right, up, backward;
};

/// A perspective camera whose position is not chosen yet: its axes, and the tangents of half its field of view along x
/// and y of the image, with a small margin at every edge.
struct ViewFrame {
  ViewAxes axes;
  double across, along;
};

/// `fov` in degrees over the shorter axis of the image, whose aspect ratio is `aspect`.
ViewFrame view_frame(const ViewAxes& axes, double aspect, double fov);

/// How far points reach towards each edge of a frame, and towards the camera. A point is visible if
/// |x - eye.x| <= tangent * (eye.z - z), in coordinates along right, up and backward; so the largest x + tangent * z
/// and the largest -x + tangent * z of all points determine the eye's position between them and its distance.
struct ViewReach {
  double to_right = -1e300, to_left = -1e300, to_top = -1e300, to_bottom = -1e300, nearest = -1e300;

  /// `p` is relative to the point that eye() is relative to.
  void add(const ViewFrame& frame, const Vec3d& p);
  /// Adds `p` turned by every angle about the axis `up`, of unit length.
  void add_all_round(const ViewFrame& frame, const Vec3d& p, const Vec3d& up);
  void add(const ViewReach& other);
  /// The position from which the camera sees all points, and has none nearer than `min_distance`.
  Vec3d eye(const ViewFrame& frame, double min_distance) const;
};

/// The position from which a camera with these axes and that field of view (degrees over the shorter axis of the image)
/// sees all `shapes` of `scene`, with a small margin at every edge.
Vec3d fitting_eye(const Scene& scene, const std::vector<PlacedShape>& shapes, double aspect, const ViewAxes& axes,
                  double fov);

/// The transform of a camera at `eye`, whose axes in world space are its right, up and forward. Throws InputError if
/// they are out of range.
Transform world_from_camera(const Vec3d& eye, const Vec3d& right, const Vec3d& up, const Vec3d& forward);

/// Adds white light from everywhere, more of it from above, and from windows: a bright one in front of and above the
/// scene, others beside and behind it.
void add_neutral_light(Scene& scene);

}  // namespace alhazen::impl
