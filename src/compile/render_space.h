#pragma once

// The space in which a scene is rendered: the world, or, if the scene is far from the world's origin, the world
// translated so that coordinates are small where they are seen. In float a metre at 100 km is resolved to 8 mm. (pbrt
// renders relative to the camera for the same reason; PBR 4th ed., 5.1.1.)

#include "scene/scene.h"

namespace alhazen::impl {

/// Translates everything that has a position, in double precision. Scenes whose camera distance or size is comparable
/// to their distance from the origin remain unchanged, and so do their images, to the last bit. Returns the point of
/// the world that has become the origin.
Vec3d move_to_render_space(Scene& scene);

/// Whether it would leave the scene, seen by that camera, as it is.
bool is_in_render_space(const Scene& scene, const Camera& camera);

}  // namespace alhazen::impl
