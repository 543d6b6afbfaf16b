#pragma once

// Independent uniform random numbers from a counter hash.

#include "core/math/vec.h"
#include "core/sampling/hash.h"
#include "core/sampling/sampler.h"

namespace ALHAZEN_CORE {

class IndependentSampler {
 public:
  IndependentSampler() = default;
  ALHAZEN_HD IndependentSampler(SampleSeed seed, uint32_t x, uint32_t y, uint32_t sample)
      // Complemented; otherwise pixel (a, seed) at sample b would get the numbers of pixel (b, seed) at sample a.
      : key_(mix64(mix64((static_cast<uint64_t>(y) << 32) | x) +
                   mix64(~((static_cast<uint64_t>(seed.seed) << 32) | sample)))) {}

  template <class Real>
  ALHAZEN_HD Real get_1d(uint32_t dimension) const {
    return unit_interval<Real>(static_cast<uint32_t>(bits(dimension) >> 32));
  }

  template <class Real>
  ALHAZEN_HD Vec2<Real> get_2d(uint32_t dimension) const {
    const uint64_t b = bits(dimension);
    return {unit_interval<Real>(static_cast<uint32_t>(b >> 32)), unit_interval<Real>(static_cast<uint32_t>(b))};
  }

  /// A sampler with other numbers for branch `branch` of a path that forks.
  ALHAZEN_HD IndependentSampler fork(uint32_t branch) const {
    IndependentSampler child = *this;
    child.key_ = mix64(key_ + 0x9e3779b97f4a7c15u * (branch + 1));
    return child;
  }

 private:
  ALHAZEN_HD uint64_t bits(uint32_t dimension) const { return mix64(key_ ^ (dimension * 0xd1342543de82ef95u)); }

  uint64_t key_ = 0;
};

}  // namespace ALHAZEN_CORE
