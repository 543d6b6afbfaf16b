#pragma once

// The principled BSDFs, as the principled material of this renderer.

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

/// `principled`, a solid.
Material read_principled(Build& build, ObjectReader& reader);
/// `principledthin`, a thin sheet.
Material read_principled_thin(Build& build, ObjectReader& reader);

}  // namespace alhazen::impl::mitsuba
