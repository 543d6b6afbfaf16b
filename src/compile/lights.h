#pragma once

// The part of scene compilation that makes the records of lights and gives each its probability.

#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Appends the lights of the description that are not shapes to out.lights, with their measures, and sets the
/// background of `view`. Constant infinite lights are summed into one. The texels of maps are freed as they are copied.
/// Returns the index in Scene::lights of each light that was appended.
template <class Real>
std::vector<size_t> add_described_lights(Scene& scene, SceneArrays<Real>& out, SceneView<Real>& view,
                                         std::vector<double>& measures);

/// Gives every light its probability: half for infinite lights if there are both kinds, and within each half by power;
/// finite lights use a light tree if `sampling` requests one. `measures`, by light: for shapes the area times the mean
/// of the texture, for images the integral over all directions; unused for other kinds.
template <class Real>
void assign_light_probabilities(const std::vector<double>& measures, LightSampling sampling, SceneArrays<Real>& out,
                                SceneView<Real>& view);

/// Collects the data for sampling triangle lights, whose vertices are final once the trees are built.
template <class Real>
void add_triangle_emitters(SceneArrays<Real>& out);

/// A light tree is built if there are more finite lights than this.
inline constexpr size_t max_lights_without_tree = 2;

/// Returns whether all lights are delta lights, which only shadow rays find. `view` has the constant infinite light.
template <class Real>
bool has_only_delta_lights(const SceneArrays<Real>& out, const SceneView<Real>& view);

}  // namespace alhazen::impl
