#pragma once

// Scenes of cost against the number of objects and against depth: a cloud of spheres under a white sky.

#include "scene/scene.h"

namespace alhazen::study {

/// `count` spheres at random in a cube that fills the picture, the same for the same number. Radii fall with the root
/// of the number, so that a ray goes as far between two spheres, and a path has about as many segments, whatever the
/// number. Diffuse ones leave gaps; those of glass stand so dense, one within another, that hardly a path gets out.
Scene cloud_of_spheres(uint64_t count, bool is_glass);

}  // namespace alhazen::study
