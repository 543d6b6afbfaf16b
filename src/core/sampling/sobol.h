#pragma once

// Owen-scrambled Sobol' points, shuffled and padded across dimensions
// (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)); on request in an order by which neighbouring pixels
// share well distributed points, so that their errors cancel when the eye averages them: blue noise (Ahmed, Wonka 2020,
// "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels").

#include "core/math/vec.h"
#include "core/sampling/hash.h"
#include "core/sampling/sampler.h"

namespace ALHAZEN_CORE {

/// Scrambles the bits of a number given in reversed bit order, each bit by the bits below it (Laine and Karras 2011,
/// with the constants of Vegdahl 2021).
ALHAZEN_HD constexpr uint32_t laine_karras(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The bits of the second Sobol' dimension at `index`, reversed: bit k is the sum modulo 2 of the index bits j with
/// C(j, k) odd, that is with k a submask of j. Five butterfly steps instead of a matrix.
ALHAZEN_HD constexpr uint32_t sobol_second_reversed(uint32_t index) {
  uint32_t x = index;
  x ^= (x >> 1) & 0x55555555u;
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= (x >> 16) & 0x0000ffffu;
  return x;
}

/// Moves bit i to bit 2 i, for the low 16 bits.
ALHAZEN_HD constexpr uint32_t spread_bits(uint32_t x) {
  x &= 0xffffu;
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

class SobolSampler {
 public:
  SobolSampler() = default;
  ALHAZEN_HD SobolSampler(SampleSeed seed, uint32_t x, uint32_t y, uint32_t sample) {
    const uint32_t image_seed = combine32(0x2545f491u, seed.seed);
    if (seed.screen_order == 0) {
      pixel_seed_ = combine32(combine32(image_seed, x), y);
      reversed_sample_ = reverse_bits(sample);
      return;
    }
    // The sequence has 2^32 points: groups of pixels, and samples beyond the number planned, have their own.
    const uint32_t bits = seed.screen_order - 1;
    const uint64_t curve = (uint64_t{spread_bits(x) | (spread_bits(y) << 1)} << bits) | (sample & ((1u << bits) - 1));
    const uint32_t beyond = combine32(sample >> bits, combine32(x >> 16, y >> 16));
    pixel_seed_ = combine32(combine32(image_seed, static_cast<uint32_t>(curve >> 32)), beyond);
    reversed_sample_ = reverse_bits(static_cast<uint32_t>(curve));
  }

  template <class Real>
  ALHAZEN_HD Real get_1d(uint32_t dimension) const {
    const uint32_t seed = combine32(pixel_seed_, dimension);
    const uint32_t index = shuffled_index(seed);
    return unit_interval<Real>(reverse_bits(laine_karras(index, mix32(seed ^ 0xa511e9b3u))));
  }

  template <class Real>
  ALHAZEN_HD Vec2<Real> get_2d(uint32_t dimension) const {
    const uint32_t seed = combine32(pixel_seed_, dimension);
    const uint32_t index = shuffled_index(seed);
    return {unit_interval<Real>(reverse_bits(laine_karras(index, mix32(seed ^ 0xa511e9b3u)))),
            unit_interval<Real>(reverse_bits(laine_karras(sobol_second_reversed(index), mix32(seed ^ 0x63d83595u))))};
  }

  /// A sampler with other numbers for branch `branch` of a path that forks.
  ALHAZEN_HD SobolSampler fork(uint32_t branch) const {
    SobolSampler child = *this;
    child.pixel_seed_ = combine32(pixel_seed_ ^ 0x68bc21ebu, branch);
    return child;
  }

 private:
  /// The sample's index, shuffled differently for each dimension so that dimensions do not correlate.
  ALHAZEN_HD uint32_t shuffled_index(uint32_t seed) const { return reverse_bits(laine_karras(reversed_sample_, seed)); }

  uint32_t pixel_seed_ = 0;
  uint32_t reversed_sample_ = 0;
};

}  // namespace ALHAZEN_CORE
