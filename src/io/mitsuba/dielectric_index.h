#pragma once

// Indices of refraction, as numbers or by the names of materials.

#include "io/mitsuba/object_reader.h"

namespace alhazen::impl::mitsuba {

/// The index inside (`int_ior`) relative to that outside (`ext_ior`, air). Throws InputError.
double relative_ior(ObjectReader& reader, const char* interior);

/// The fraction of diffuse light from within that an interface of that index and alpha (GGX) reflects, by single
/// scattering.
double internal_diffuse_reflectance(double ior, double alpha);

}  // namespace alhazen::impl::mitsuba
