#pragma once

// What samplers have in common.

#include <concepts>
#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

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
