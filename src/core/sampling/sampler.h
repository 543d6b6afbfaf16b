#pragma once

// What samplers have in common.

#include <concepts>
#include <cstdint>

#include "core/math/platform.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// What the random numbers of an image start from.
struct SampleSeed {
  uint32_t seed = 0;
  /// 0: pixels are independent. Else: 1 and the logarithm to base 2 of the number of samples per pixel, and pixels
  /// along a Z-order curve take successive parts of one sequence. Only Sobol' points can.
  uint32_t screen_order = 0;

  SampleSeed() = default;
  ALHAZEN_HD constexpr SampleSeed(uint32_t value, uint32_t order = 0) : seed(value), screen_order(order) {}
};

/// The random numbers of one sample of a pixel, each in [0, 1). Equal dimensions return equal numbers; a pair takes one
/// dimension. core/sampling/dimensions.h says what each is for.
template <class Sampler, class Real>
concept SamplerOf = requires(const Sampler& sampler, uint32_t dimension) {
  { sampler.template get_1d<Real>(dimension) } -> std::same_as<Real>;
  { sampler.template get_2d<Real>(dimension) } -> std::same_as<Vec2<Real>>;
};

/// Also returns samplers for the branches of a path that forks.
template <class Sampler, class Real>
concept ForkingSampler = SamplerOf<Sampler, Real> && requires(const Sampler& sampler, uint32_t branch) {
  { sampler.fork(branch) } -> std::same_as<Sampler>;
};

}  // namespace ALHAZEN_CORE
