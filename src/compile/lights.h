#pragma once

// The part of compiling that gives each light its probability.

#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// Appends the lights of the description (not those that are shapes) to out.lights, with their measures, and sets the
/// background of `view`. Constant infinite lights are summed into one. The texels of maps are freed as they are placed.
template <class Real>
void add_described_lights(Scene& scene, SceneArrays<Real>& out, SceneView<Real>& view, std::vector<double>& measures);

/// Gives every light its probability: half for those at infinity where there are both kinds, within each half by power;
/// those of finite distance by a light tree where `sampling` asks for one. `measures`, by light: the area of shapes
/// times the mean of their texture, the integral of pictures over all directions; of other kinds it is not looked at.
template <class Real>
void assign_light_probabilities(const std::vector<double>& measures, LightSampling sampling, SceneArrays<Real>& out,
                                SceneView<Real>& view);

/// Lays down what sampling the triangles among the lights needs, where they are after the trees have been built.
template <class Real>
void add_triangle_emitters(SceneArrays<Real>& out);

/// A light tree is built for more lights of finite distance than that.
inline constexpr size_t max_lights_without_tree = 2;

/// Whether rays of paths find no light, so that how shadow rays fare alone says what is lit.
template <class Real>
bool has_only_lights_without_size(const SceneArrays<Real>& out);

}  // namespace alhazen
