#pragma once

// Shape, and the objects that group shapes.

#include <string>

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

void add_shape(Build& build, const std::string& kind, ParameterList& list);

/// Makes meshes of the exact shapes of groups that are not exact any more where an instance places them: spheres stay
/// spheres only under rotation, translation and uniform scale.
void tessellate_for_instances(Build& build);

}  // namespace alhazen::impl::pbrt
