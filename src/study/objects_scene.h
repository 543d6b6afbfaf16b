#pragma once

// Scenes for measuring cost against the number of objects and against depth: a cloud of spheres under a white sky.

#include "scene/scene.h"

namespace alhazen::impl::study {

/// `count` random spheres in a cube that fills the image, the same for equal counts. Radii are proportional to the
/// inverse square root of the count, so that mean free path and path length do not depend on it. Diffuse clouds have
/// gaps; glass ones are so dense, with overlapping spheres, that hardly any path escapes.
Scene cloud_of_spheres(uint64_t count, bool is_glass);

}  // namespace alhazen::impl::study
