#pragma once

// One-sided surfaces, as in glTF, are invisible to the camera from behind, so that it sees into rooms from outside.
// Light transport there follows what the camera sees: a triangle whose back the camera sees is absent for light as for
// the camera, and every other one stops light from both sides. So light enters a room where the camera looks in, and a
// card whose front is visible casts its shadow whichever side the light is on.

#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Handles one-sided triangles that coincide with another one facing the other way, as leaves and cloth are often
/// modelled: their new surface shows every ray only its front, since the other triangle is its back.
template <class Real>
void split_coincident_sides(SceneArrays<Real>& out);

/// Gives one-sided triangles whose back the camera sees, with nothing but other such backs in between, a surface that
/// lets all rays through. If all lights are delta lights and the camera sees the scene from outside, triangles that are
/// connected by corners to such a triangle admit light from behind: a sun shines through a ceiling that is seen from
/// below. Emissive triangles are left unchanged, and so are the triangles of objects, which have several instances.
/// `view` is that of `out`, with the camera, whose image has that size, and with the binary tree. Returns whether there
/// are any.
template <class Real>
bool open_seen_backs(const SceneView<Real>& view, uint32_t width, uint32_t height, int threads, SceneArrays<Real>& out);

/// The same for one camera after another: prepares the surfaces that it may need, with none open yet. To be called once
/// all surfaces are there.
template <class Real>
BackOpenings prepare_openings(const SceneView<Real>& view, SceneArrays<Real>& out);

/// Closes all backs of the compiled `scene` again.
template <class Real>
void close_backs(CompiledScene<Real>& scene);

/// Opens the backs that the camera of the compiled `scene` sees, and closes those that another camera saw. The scene
/// must have the binary tree.
template <class Real>
void open_seen_backs(uint32_t width, uint32_t height, int threads, CompiledScene<Real>& scene);

}  // namespace alhazen::impl
