#pragma once

// The one piece of compiled code by which every backend of the CPU takes samples. That it is one is what makes their
// pictures the same bits: the compiler may fuse and reorder within it, but does so once.

#include <cstdint>

#include "core/integrators/camera_sample.h"
#include "core/scene_view.h"
#include "render/film.h"
#include "scene/scene.h"

namespace alhazen {

/// Takes samples [first, first + count), count <= samples_per_block, of pixel (x, y) of the whole picture.
template <class Real>
using SampleKernel = BlockSum<Real> (*)(const SceneView<Real>& scene, uint32_t seed, uint32_t max_segments, uint32_t x,
                                        uint32_t y, uint32_t first, uint32_t count);

template <class Real>
SampleKernel<Real> select_sample_kernel(IntegratorKind integrator, SamplerType sampler);

template <>
SampleKernel<float> select_sample_kernel(IntegratorKind integrator, SamplerType sampler);
template <>
SampleKernel<double> select_sample_kernel(IntegratorKind integrator, SamplerType sampler);

}  // namespace alhazen
