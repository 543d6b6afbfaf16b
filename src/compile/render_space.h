#pragma once

// The space that a scene is rendered in: the world, or, where the scene is far from the world's origin, the world moved
// so that coordinates are small where they are seen. In float a metre at 100 km is resolved to 8 mm. (pbrt renders
// about the camera for the same reason; PBR 4th ed., 5.1.1.)

#include "scene/scene.h"

namespace alhazen {

/// Moves everything that has a place, in double precision. Scenes whose camera or whose own size is comparable to their
/// distance from the origin stay as they are, and so do their pictures, to the last bit.
void move_to_render_space(Scene& scene);

}  // namespace alhazen
