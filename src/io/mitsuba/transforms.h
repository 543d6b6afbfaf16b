#pragma once

// The operations within <transform>.

#include "io/mitsuba/attributes.h"
#include "scene/transform.h"

namespace alhazen::impl::mitsuba {

/// The transform of an element whose children are translate, rotate, scale, lookat and matrix; the first is applied
/// first. Attributes have their parameters replaced. Throws InputError.
Transform read_transform(const Element& element);

}  // namespace alhazen::impl::mitsuba
