#pragma once

// Shape, and the objects that group shapes.

#include <string>

#include "io/pbrt/build.h"

namespace alhazen::pbrt {

void add_shape(Build& build, const std::string& kind, ParameterList& list);

/// Spheres stay spheres only under rotation, translation and uniform scale. Spheres in groups with other instance
/// transforms become meshes.
void tessellate_spheres_of_skewed_instances(Build& build);

}  // namespace alhazen::pbrt
