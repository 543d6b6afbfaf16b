#pragma once

// The part of flattening that makes camera and pixel filter.

#include "scene/scene.h"
#include "scene/scene_arrays.h"

namespace alhazen {

/// Camera for a picture of width x height pixels, and the table of the filter.
template <class Real>
void flatten_camera(const Scene& scene, int64_t width, int64_t height, SceneArrays<Real>& out, SceneView<Real>& view,
                    Diagnostics& diagnostics);

/// The filter's value `x` pixels from its centre along one axis (all filters are products of two such).
double filter_value(const Filter& filter, double x, double radius);

}  // namespace alhazen
