#pragma once

// BSDFs.

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

/// The BSDF that `property` holds, read once for each object.
ReadBsdf read_bsdf(Build& build, const Property& property);

/// The BSDF of shapes that name none: diffuse with reflectance 0.5.
ReadBsdf default_bsdf(Build& build);

}  // namespace alhazen::impl::mitsuba
