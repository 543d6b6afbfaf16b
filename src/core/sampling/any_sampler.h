#pragma once

// A sampler whose kind is known only at run time, for kernels that are not compiled once per sampler.

#include "core/sampling/independent.h"
#include "core/sampling/sobol.h"

namespace ALHAZEN_CORE {

enum class SamplerType : uint32_t {
  sobol,
  independent,
  zsobol,  ///< sobol with a SampleSeed::screen_order
};

/// Returns the same numbers as the sampler of its kind.
class AnySampler {
 public:
  ALHAZEN_HD AnySampler(SamplerType type, SampleSeed seed, uint32_t x, uint32_t y, uint32_t sample)
      : type_(type), sobol_(seed, x, y, sample) {
    if (type == SamplerType::independent) independent_ = IndependentSampler(seed, x, y, sample);
  }

  template <class Real>
  ALHAZEN_HD Real get_1d(uint32_t dimension) const {
    return type_ == SamplerType::independent ? independent_.get_1d<Real>(dimension) : sobol_.get_1d<Real>(dimension);
  }

  template <class Real>
  ALHAZEN_HD Vec2<Real> get_2d(uint32_t dimension) const {
    return type_ == SamplerType::independent ? independent_.get_2d<Real>(dimension) : sobol_.get_2d<Real>(dimension);
  }

 private:
  SamplerType type_;
  union {
    SobolSampler sobol_;
    IndependentSampler independent_;
  };
};

}  // namespace ALHAZEN_CORE
