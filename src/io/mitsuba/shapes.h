#pragma once

// Shapes, with the area lights that they are.

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

/// Adds the shape that `property` holds to the scene. Groups of shapes are added when an instance names them.
void add_shape(Build& build, const Property& property);

/// Makes meshes of what instances place by transforms that it is not exact under.
void tessellate_for_instances(Build& build);

}  // namespace alhazen::impl::mitsuba
