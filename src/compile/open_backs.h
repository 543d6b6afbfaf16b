#pragma once

// Surfaces of one side, as glTF has them, show the camera nothing from behind, so that it looks into rooms from
// outside. What light does there follows from what the camera sees: a triangle whose back the camera looks at is not
// there, for light as for the camera, and every other one stops light from both sides. So light comes into a room the
// way that the camera looks in, and a card whose front is seen throws its shadow whichever side the light is on.

#include "compile/scene_arrays.h"

namespace alhazen {

/// Gives triangles of one side that lie in one place with another which looks the other way, as leaves and cloth are
/// often modelled, a surface of which every ray sees the front alone: the other one is its back.
template <class Real>
void split_coincident_sides(SceneArrays<Real>& out);

/// Gives triangles of one side whose back is seen from the camera, with nothing but other such backs in between, a
/// surface that lets all rays through. Where all lights are without size, which no ray of a path hits, and the camera
/// looks at the scene from outside, what has corners in common with such a triangle, or with what has, lets in light
/// from behind: a sun shines through a ceiling that is seen from below. What shines is left as it is, and so are the
/// triangles of objects, which stand in several places. `view` is that of `out`, with the camera, whose picture has
/// that size, and the binary tree. Returns whether there are any.
template <class Real>
bool open_seen_backs(const SceneView<Real>& view, uint32_t width, uint32_t height, int threads, SceneArrays<Real>& out);

}  // namespace alhazen
