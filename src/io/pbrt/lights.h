#pragma once

// LightSource and AreaLightSource.

#include <string>

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

void add_light(Build& build, const std::string& kind, ParameterList& list);
void set_area_light(Build& build, const std::string& kind, ParameterList& list);

}  // namespace alhazen::impl::pbrt
