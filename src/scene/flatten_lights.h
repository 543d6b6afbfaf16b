#pragma once

// The part of flattening that gives each light its probability.

#include "scene/scene.h"
#include "scene/scene_arrays.h"

namespace alhazen {

/// Appends the lights of the description (not those that are shapes) to out.lights and sets the background of `view`.
/// Constant infinite lights are summed into one. The texels of maps are freed as they are placed.
template <class Real>
void add_described_lights(Scene& scene, SceneArrays<Real>& out, SceneView<Real>& view);

/// Gives every light its probability: half for those at infinity where there are both kinds, within each half by power.
/// `areas` are the areas of the lights that are shapes, by index; others are not looked at.
template <class Real>
void assign_light_probabilities(const std::vector<double>& areas, SceneArrays<Real>& out);

}  // namespace alhazen
