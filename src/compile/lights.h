#pragma once

// The part of scene compilation that makes the records of lights and gives each its probability.

#include <vector>

#include "compile/light_maps.h"
#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Appends the lights of the description that are not shapes to out.lights, with their measures, and sets the
/// background of `view`. Constant infinite lights are summed into one. The texels of maps are freed as they are copied.
/// What `maps` has already is not appended, and `texels` are those that its records refer to; the rest is added to it.
/// Returns the index in Scene::lights of each light that was appended.
template <class Real>
std::vector<size_t> add_described_lights(Scene& scene, const float* texels, LightMaps<Real>& maps,
                                         SceneArrays<Real>& out, SceneView<Real>& view, std::vector<double>& measures);

/// Gives every light its probability: half for infinite lights if there are both kinds, and within each half by power;
/// finite lights use a light tree if `sampling` requests one. `measures`, by light: for shapes the area times the mean
/// of the texture, for images the integral over all directions; unused for other kinds. `shapes` has the primitives
/// that lights refer to, and the images of lights.
template <class Real>
void assign_light_probabilities(const std::vector<double>& measures, LightSampling sampling,
                                const SceneView<Real>& shapes, SceneArrays<Real>& out, SceneView<Real>& view);

/// Collects the data for sampling triangle lights, whose vertices are final once the trees are built.
template <class Real>
void add_triangle_emitters(const SceneView<Real>& shapes, SceneArrays<Real>& out);

/// A light tree is built if there are more finite lights than this.
inline constexpr size_t max_lights_without_tree = 2;

/// Returns whether all lights are delta lights, which only shadow rays find. `view` has the constant infinite light.
template <class Real>
bool has_only_delta_lights(const std::vector<LightRecord<Real>>& lights, const SceneView<Real>& view);

}  // namespace alhazen::impl
