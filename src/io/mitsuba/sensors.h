#pragma once

// Sensors with their films, pixel filters and samplers, and integrators.

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

void set_sensor(Build& build, const Property& property);
void set_integrator(Build& build, const Property& property);

}  // namespace alhazen::impl::mitsuba
