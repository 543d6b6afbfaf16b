#pragma once

// Emitters that are not shapes.

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

/// Adds the emitter that `property` holds to the lights of the scene.
void add_emitter(Build& build, const Property& property);

}  // namespace alhazen::impl::mitsuba
