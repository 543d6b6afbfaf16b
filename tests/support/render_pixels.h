#pragma once

// Renders images pixel by pixel with the sample kernel of the CPU backends.

#include <algorithm>
#include <string>

#include "render/sample_kernel.h"
#include "render/settings.h"
#include "support/statistics.h"

namespace alhazen::impl::test {

inline constexpr IntegratorKind all_integrators[] = {IntegratorKind::branching, IntegratorKind::recursive,
                                                     IntegratorKind::iterative, IntegratorKind::path};
inline constexpr SamplerType all_samplers[] = {SamplerType::sobol, SamplerType::independent};

/// The settings with which pixels are rendered.
struct Take {
  IntegratorKind integrator = IntegratorKind::path;
  SamplerType sampler = SamplerType::sobol;
  uint32_t max_segments = 6;
  uint32_t samples = 16;  ///< per pixel
  uint32_t seed = 0;

  std::string name() const {
    return to_string(integrator) + ", " + to_string(sampler) + ", D = " + std::to_string(max_segments) + ", seed " +
           std::to_string(seed);
  }
};

/// Returns the mean radiance of one pixel, weighted by the pixel filter.
template <class Real>
Vec3d render_pixel(const SceneView<Real>& scene, const Take& take, uint32_t x, uint32_t y) {
  const SampleKernel<Real> kernel = select_sample_kernel<Real>(take.integrator, take.sampler);
  Vec3d sum{};
  double weight = 0;
  for (uint32_t first = 0; first < take.samples; first += samples_per_block) {
    const uint32_t count = std::min(samples_per_block, take.samples - first);
    const BlockRequest request{x, y, first, count};
    BlockSum<Real> block;
    kernel(scene, nullptr, take.seed, take.max_segments, &request, 1, &block);
    sum += convert<double>(block.radiance);
    weight += static_cast<double>(block.weight);
  }
  return sum / weight;
}

/// Returns the moments of the luminance of the pixels. Pixels are independent of each other, samples within a pixel
/// need not be.
template <class Real>
Moments render_pixels(const SceneView<Real>& scene, const Take& take, uint32_t width, uint32_t height) {
  Moments moments;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) moments.add(luminance(render_pixel(scene, take, x, y)));
  return moments;
}

}  // namespace alhazen::impl::test
