#pragma once

// The scene of cost against the number of objects: a cloud of diffuse spheres under a white sky.

#include "scene/scene.h"

namespace alhazen::study {

/// `count` spheres at random in a cube that fills the picture. Radii fall with the root of the number, so that a ray
/// goes as far between two spheres, and a path has about as many segments, whatever the number. The same for the same
/// number.
Scene cloud_of_spheres(uint64_t count);

}  // namespace alhazen::study
