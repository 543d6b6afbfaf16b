#pragma once

// Cameras and lights for scenes, or models, that have none.

#include <vector>

#include "core/math/bounds.h"
#include "scene/scene.h"
#include "scene/transform.h"

namespace alhazen {

/// A shape where it is at the start of its motion.
struct PlacedShape {
  const Shape* shape;
  Transform world_from_object;
  Bounds3<double> box;  ///< in world space; of shapes other than meshes it may be larger than needed
};

/// All shapes, also those of instances. They point into `scene`.
std::vector<PlacedShape> placed_shapes(const Scene& scene);

/// Takes out what is more than 30 times as large as all that is smaller together, which must be half of the shapes or
/// more: a ground, a sky.
void leave_out_surroundings(std::vector<PlacedShape>& shapes);

/// Of the origin if there are none.
Bounds3<double> bounds_of(const std::vector<PlacedShape>& shapes);

/// Adds a camera that sees the whole scene from the front, the side and above, for an image of that aspect ratio (width
/// over height; 0: that of the film). The scene's y is up.
void fit_camera(Scene& scene, double aspect);

/// Where the camera is and where it looks. All are of unit length and perpendicular to each other.
struct ViewAxes {
  Vec3d right, up, backward;
};

/// The position from which a camera with these axes and that field of view (degrees over the shorter axis of the image)
/// sees all `shapes` of `scene`, with a small margin at every edge.
Vec3d fitting_eye(const Scene& scene, const std::vector<PlacedShape>& shapes, double aspect, const ViewAxes& axes,
                  double fov);

/// The transform of a camera at `eye`, whose axes in world space are its right, up and forward.
Transform world_from_camera(const Vec3d& eye, const Vec3d& right, const Vec3d& up, const Vec3d& forward);

/// Adds white light from everywhere, more of it from above, and from windows: a bright one in front of and above the
/// scene, others beside and behind it.
void add_neutral_light(Scene& scene);

}  // namespace alhazen
