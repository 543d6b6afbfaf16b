#pragma once

// Surfaces of one side, as glTF has them, show the camera nothing from behind, so that it looks into rooms from
// outside. What light does there follows from what the camera sees: a triangle whose back the camera looks at is not
// there, for light as for the camera, and every other one stops light from both sides. So light comes into a room the
// way that the camera looks in, and a card whose front is seen throws its shadow whichever side the light is on.

#include "scene/scene_arrays.h"

namespace alhazen {

/// Gives triangles of one side whose back is seen from the camera, with nothing but other such backs in between, a
/// surface that lets all rays through. What shines is left as it is, and so are the triangles of objects, which stand
/// in several places. `view` is that of `out`, with the camera and the binary tree. Returns whether there are any.
template <class Real>
bool open_seen_backs(const SceneView<Real>& view, int threads, SceneArrays<Real>& out);

/// Whether the camera looks at the scene from outside. There light without size, which no ray of a path meets, may come
/// into rooms through any back, as a sun does through a ceiling that is seen from below.
template <class Real>
bool stands_in_the_open(const SceneView<Real>& view);

}  // namespace alhazen
