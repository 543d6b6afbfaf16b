#pragma once

// What cameras are placed for: the scene without its surroundings.

#include <optional>
#include <vector>

#include "scene/default_view.h"

namespace alhazen::impl {

/// A ground, a backdrop or a sky is left out, so that the rest is in the image: what is more than 30 times as large as
/// all that is smaller together, which must be half of the shapes or more; and what is more than 3 times as large as
/// the box that holds the middle 90 percent of the vertices along each axis, unless it has half of them itself. A mesh
/// counts by its vertices up to a thousand, and any other shape as 128.
struct Subject {
  /// The centre of that box: a large floor of few vertices does not move it. The origin if there is nothing.
  Vec3d middle;
  double size = 0;  ///< the diagonal of the box of all that counts
  ViewReach reach;  ///< of all that counts, relative to the origin, if there was a frame
  std::vector<PlacedShape> shapes;
};

/// Reads every vertex once. Without a frame nothing is known of the reach.
Subject find_subject(const Scene& scene, const std::optional<ViewFrame>& frame);

/// The position from which a camera with that frame sees the subject, with a small margin at every edge.
Vec3d fitting_eye(const Subject& subject, const ViewFrame& frame);

/// The same while the camera turns about the axis `up`, of unit length, through the subject's middle.
Vec3d all_round_fitting_eye(const Scene& scene, const Subject& subject, const ViewFrame& frame, const Vec3d& up);

}  // namespace alhazen::impl
