#pragma once

// The metals that are built in.

#include "alhazen/materials.h"
#include "colour/spectrum.h"

namespace alhazen::impl {

ConductorRgb metal_rgb(alhazen::Metal metal);

}  // namespace alhazen::impl
