#pragma once

// The part of scene compilation that makes the camera and the pixel filter.

#include <string>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// The record of a camera for an image of width x height pixels. `scene_name` is for messages.
template <class Real>
CameraRecord<Real> camera_record(const Camera& camera, const std::string& scene_name, int64_t width, int64_t height);

/// The camera for an image of width x height pixels, and the table of the filter.
template <class Real>
void compile_camera(const Scene& scene, int64_t width, int64_t height, SceneArrays<Real>& out, SceneView<Real>& view,
                    Diagnostics& diagnostics);

/// The filter's value `x` pixels from its centre along one axis (every filter is a product over the two axes).
double filter_value(const Filter& filter, double x, double radius);

}  // namespace alhazen::impl
