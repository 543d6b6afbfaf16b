// Samplers are pure functions of their arguments with values in [0, 1). Sobol' points form nets, and no dimension is
// used twice.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/sampling/dimensions.h"
#include "core/sampling/independent.h"
#include "core/sampling/sobol.h"

namespace alhazen::impl::test {
namespace {

template <class Sampler>
class SamplerOf : public ::testing::Test {};
using Samplers = ::testing::Types<IndependentSampler, SobolSampler>;
TYPED_TEST_SUITE(SamplerOf, Samplers);

TYPED_TEST(SamplerOf, SameNumbersForTheSameArguments) {
  const TypeParam a(1, 2, 3, 4), b(1, 2, 3, 4);
  EXPECT_EQ(a.template get_1d<double>(9), b.template get_1d<double>(9));
  // The order of draws does not matter, and a float is the truncated double.
  const Vec2d first = a.template get_2d<double>(5);
  b.template get_2d<double>(6);
  EXPECT_EQ(first, b.template get_2d<double>(5));
  EXPECT_NEAR(static_cast<double>(a.template get_2d<float>(5).x), first.x, 0x1p-24);
  EXPECT_LE(static_cast<double>(a.template get_2d<float>(5).x), first.x);
}

TYPED_TEST(SamplerOf, BelowOne) {
  for (uint32_t i = 0; i < 100'000; ++i) {
    const Vec2f u = TypeParam(i, 7, 11, i).template get_2d<float>(i % 50);
    ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
  }
  EXPECT_LT(unit_interval<float>(0xffffffffu), 1.0f);
  EXPECT_LT(unit_interval<double>(0xffffffffu), 1.0);
}

/// Every argument matters, and none is equivalent to another: pixels, samples, seeds and branches with the same numbers
/// would have the same errors.
TYPED_TEST(SamplerOf, NoTwoHaveTheSameNumbers) {
  std::vector<std::array<uint32_t, 4>> numbers;
  const auto draw = [&](const TypeParam& sampler) {
    std::array<uint32_t, 4> bits;
    for (uint32_t d = 0; d < 4; ++d) bits[d] = static_cast<uint32_t>(sampler.template get_1d<double>(d) * 0x1p32);
    numbers.push_back(bits);
  };
  for (uint32_t seed = 0; seed < 6; ++seed)
    for (uint32_t x = 0; x < 12; ++x)
      for (uint32_t y = 0; y < 12; ++y)
        for (uint32_t sample = 0; sample < 12; ++sample) {
          const TypeParam sampler(seed, x, y, sample);
          draw(sampler);
          for (uint32_t branch = 0; branch < 2; ++branch) {
            draw(sampler.fork(branch));
            for (uint32_t next = 0; next < 2; ++next) draw(sampler.fork(branch).fork(next));
          }
        }
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end());
}

/// Every elementary interval of area 2^-k contains exactly one of the first 2^k points, and of any 2^k consecutive ones
/// that start at a multiple of 2^k, in every pair of dimensions.
TEST(Sobol, PointsAreNets) {
  for (const uint32_t dimension : {0u, 1u, 4u, 5u, 29u})
    for (uint32_t k = 1; k <= 12; ++k)
      for (const uint32_t first : {0u, 3u << k})
        for (uint32_t columns = 0; columns <= k; ++columns) {
          std::vector<int> cells(size_t{1} << k);
          for (uint32_t i = 0; i < 1u << k; ++i) {
            const Vec2d u = SobolSampler(1, 20, 30, first + i).get_2d<double>(dimension);
            const uint32_t column = static_cast<uint32_t>(u.x * (1u << columns));
            const uint32_t row = static_cast<uint32_t>(u.y * (1u << (k - columns)));
            ++cells[(row << columns) + column];
          }
          ASSERT_EQ(std::count(cells.begin(), cells.end(), 1), static_cast<std::ptrdiff_t>(cells.size()))
              << "dimension " << dimension << ", k " << k << ", columns 2^" << columns;
        }
}

/// With a screen order the samples of a pixel form nets too, and so do those of aligned blocks of pixels together.
TEST(ZSobol, BlocksOfPixelsShareNets) {
  for (const uint32_t samples : {1u, 4u, 16u})
    for (const uint32_t block : {1u, 2u, 4u, 8u})
      for (const uint32_t dimension : {0u, 1u, 5u, 29u}) {
        const SampleSeed seed(3, 1 + static_cast<uint32_t>(std::countr_zero(samples)));
        const uint32_t count = samples * block * block;
        const auto k = static_cast<uint32_t>(std::countr_zero(count));
        for (uint32_t columns = 0; columns <= k; ++columns) {
          std::vector<int> cells(count);
          for (uint32_t i = 0; i < count; ++i) {
            const uint32_t pixel = i / samples, x = 5 * block + pixel % block,
                           y = 70'000 / block * block + pixel / block;
            const Vec2d u = SobolSampler(seed, x, y, i % samples).get_2d<double>(dimension);
            ++cells[(static_cast<uint32_t>(u.y * (1u << (k - columns))) << columns) +
                    static_cast<uint32_t>(u.x * (1u << columns))];
          }
          ASSERT_EQ(std::count(cells.begin(), cells.end(), 1), static_cast<std::ptrdiff_t>(count))
              << samples << " samples, block " << block << ", dimension " << dimension << ", columns 2^" << columns;
        }
      }
}

TEST(ZSobol, NoTwoSamplesAreEqual) {
  // Also beyond the number planned, and where the curve is longer than the sequence.
  for (const uint32_t planned : {0u, 3u, 20u}) {
    std::vector<std::array<double, 3>> numbers;
    for (const uint32_t corner : {0u, 4096u, 65'536u})
      for (uint32_t y = 0; y < 12; ++y)
        for (uint32_t x = 0; x < 12; ++x)
          for (uint32_t sample = 0; sample < 12; ++sample) {
            const SobolSampler sampler({7, 1 + planned}, corner + x, corner + y, sample);
            const Vec2d u = sampler.get_2d<double>(4);
            numbers.push_back({u.x, u.y, sampler.get_1d<double>(5)});
          }
    std::sort(numbers.begin(), numbers.end());
    EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end()) << planned;
  }
}

/// The mean squared error of an image of the same integral everywhere, blurred: that of independent pixels falls as
/// that of white noise, that of zsobol further.
TEST(ZSobol, ErrorsOfNeighboursCancel) {
  constexpr uint32_t side = 128, block = 5, samples = 4;
  const auto blurred_error = [&](uint32_t order, uint32_t dimension) {
    std::vector<double> errors(side * side);
    for (uint32_t i = 0; i < side * side; ++i) {
      uint32_t inside = 0;
      for (uint32_t sample = 0; sample < samples; ++sample) {
        const Vec2d u = SobolSampler({11, order}, i % side, i / side, sample).get_2d<double>(dimension);
        inside += u.x * u.x + u.y * u.y < 1 ? 1 : 0;
      }
      errors[i] = inside / double{samples} - 0.78539816339744831;
    }
    double sum = 0;
    for (uint32_t y = 0; y + block <= side; ++y)
      for (uint32_t x = 0; x + block <= side; ++x) {
        double mean = 0;
        for (uint32_t i = 0; i < block * block; ++i) mean += errors[(y + i / block) * side + x + i % block];
        sum += mean * mean;
      }
    return sum;
  };
  double independent = 0, ordered = 0;
  for (uint32_t dimension = 0; dimension < 16; ++dimension) {
    independent += blurred_error(0, dimension);
    ordered += blurred_error(3, dimension);
  }
  EXPECT_LT(ordered, 0.65 * independent);
}

TEST(Sobol, SingleNumbersAreStratified) {
  for (const uint32_t dimension : {2u, 3u, 7u, 40u})
    for (uint32_t k = 1; k <= 14; ++k) {
      std::vector<int> cells(size_t{1} << k);
      for (uint32_t i = 0; i < 1u << k; ++i)
        ++cells[static_cast<size_t>(SobolSampler(2, 3, 4, i).get_1d<double>(dimension) * (1u << k))];
      ASSERT_EQ(std::count(cells.begin(), cells.end(), 1), static_cast<std::ptrdiff_t>(cells.size()));
    }
}

/// The second dimension by its definition: the primitive polynomial x + 1 gives the direction numbers
/// v[i] = v[i - 1] ^ (v[i - 1] >> 1), v[0] the highest bit; the point is their sum over the bits of the index.
uint32_t sobol_second_by_definition(uint32_t index) {
  uint32_t direction = 0x80000000u, point = 0;
  for (; index != 0; index >>= 1) {
    if (index & 1) point ^= direction;
    direction ^= direction >> 1;
  }
  return point;
}

TEST(Sobol, SecondDimensionByItsDefinition) {
  for (uint32_t i = 0; i < 100'000; ++i) {
    const uint32_t index = i < 50'000 ? i : mix32(i);
    ASSERT_EQ(reverse_bits(sobol_second_reversed(index)), sobol_second_by_definition(index)) << index;
  }
}

/// Owen scrambling changes each bit by those above it only: numbers with equal first k bits still have them. Here the
/// bits are reversed.
TEST(Sobol, ScramblingIsNested) {
  for (uint32_t i = 0; i < 10'000; ++i) {
    const uint32_t x = mix32(i), seed = mix32(i + 77'777), k = i % 32;
    const uint32_t low = (1u << k) - 1, other = (x & low) | (mix32(x + 1) & ~low);
    ASSERT_EQ(laine_karras(x, seed) & low, laine_karras(other, seed) & low);
  }
}

TEST(Hash, ReverseBits) {
  EXPECT_EQ(reverse_bits(1), 0x80000000u);
  EXPECT_EQ(reverse_bits(0x0000ffffu), 0xffff0000u);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
}

/// The dimensions of a path do not overlap: neither within a vertex, nor between vertices, nor with the camera's.
TEST(Dimensions, AreDistinct) {
  std::vector<uint32_t> used{CameraDimensions::film, CameraDimensions::lens, CameraDimensions::time};
  for (uint32_t vertex = 0; vertex < 20; ++vertex) {
    const VertexDimensions d(vertex);
    used.insert(used.end(), {d.bsdf_lobe(), d.bsdf_direction(), d.light(), d.roulette()});
  }
  std::sort(used.begin(), used.end());
  EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end());
}

}  // namespace
}  // namespace alhazen::impl::test
