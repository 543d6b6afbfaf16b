#include "io/gltf/motion.h"

#include <cmath>

#include "io/gltf/matrices.h"

namespace alhazen::impl::gltf {

namespace {

/// The greatest distance, as a fraction of its length, by which the end of an axis may miss its place in the middle of
/// the motion, and as a fraction of its path by which the origin may.
constexpr double max_distortion = 0.05, max_bend = 0.25;
/// The smallest volume in the middle of the motion, as a fraction of that at the opening.
constexpr double min_volume = 0.02;

Matrix4 halfway(const Matrix4& a, const Matrix4& b) {
  Matrix4 m;
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) m[i][j] = (a[i][j] + b[i][j]) / 2;
  return m;
}

bool is_bent(const Matrix4& opening, const Matrix4& middle, const Matrix4& closing) {
  const Matrix4 linear = halfway(opening, closing);
  for (size_t axis = 0; axis < 3; ++axis)
    if (length(column(linear, axis) - column(middle, axis)) > max_distortion * length(column(middle, axis)))
      return true;
  const double path = length(column(middle, 3) - column(opening, 3)) + length(column(closing, 3) - column(middle, 3));
  return length(column(linear, 3) - column(middle, 3)) > max_bend * path && path > 0;
}

}  // namespace

Motion::Motion(const Document& document, Accessors& accessors, const Json& animation, double opening, double seconds)
    : document_(document), middle_(document, accessors), closing_(document, accessors) {
  middle_.animate(animation, opening + seconds / 2, opening);
  closing_.animate(animation, opening + seconds, opening);
  middle_.place();
  closing_.place();
}

MovingTransform Motion::of_mesh(uint32_t node, const Matrix4& opening, const Matrix4& local, const Json& where) const {
  const Transform start(opening);
  const Matrix4 closing = multiply(closing_.world(node), local), middle = multiply(middle_.world(node), local);
  if (closing == opening && middle == opening) return {start, start};
  check_transform(document_, where, closing);
  const double volume = determinant(opening);
  if (!(determinant(halfway(opening, closing)) / volume > min_volume && determinant(closing) / volume > min_volume)) {
    document_.warn(where,
                   "a mesh turns too far, or becomes flat, while the shutter is open: it is rendered at rest, where it "
                   "is when the shutter opens; give a shorter --shutter");
    return {start, start};
  }
  if (is_bent(opening, middle, closing))
    document_.warn(where,
                   "a mesh moves along a curve or turns while the shutter is open, and is rendered as if its points "
                   "moved along lines from the beginning to the end; give a shorter --shutter");
  return {start, Transform(closing)};
}

void Motion::warn_of_lights(const Nodes& opening) const {
  for (const uint32_t node : opening.drawn()) {
    const Json& description = document_.item("nodes", node);
    if (document_.extension(description, "KHR_lights_punctual") == nullptr) continue;
    if (opening.world(node) != closing_.world(node))
      document_.warn(description,
                     "lights move while the shutter is open; they are rendered at rest, where they are when it opens");
  }
}

}  // namespace alhazen::impl::gltf
