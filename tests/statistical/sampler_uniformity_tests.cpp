// Samplers: uniform in one and two dimensions, over samples of one pixel and over pixels, and uncorrelated between
// dimensions, samples, pixels, branches.

#include <gtest/gtest.h>

#include "core/sampling/independent.h"
#include "core/sampling/sobol.h"
#include "support/chi_squared_grid.h"
#include "support/effort.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t dimensions[] = {0, 1, 2, 3, 7, 18, 53};
constexpr uint32_t last_dimensions[] = {0, 1, 2, 7};
constexpr size_t cases = 2 * 2 * 2 * std::size(dimensions) + (1 + 2 * 2) * 2 * std::size(last_dimensions) + 2 * 4;
constexpr uint32_t side = 1000;

template <class Sampler>
class SamplerUniformity : public ::testing::Test {};
using Samplers = ::testing::Types<IndependentSampler, SobolSampler>;
TYPED_TEST_SUITE(SamplerUniformity, Samplers);

void expect_uniform(const UniformGrid& grid, const std::string& what) {
  const ChiSquared test = grid.test();
  EXPECT_GT(test.p_value, sidak(0.01, cases))
      << what << ": " << test.statistic << " for " << test.degrees_of_freedom << " degrees of freedom";
}

template <class Real, class Sampler, class At>
void check_uniform(const At& at, const std::string& what) {
  for (const uint32_t dimension : dimensions) {
    UniformGrid line(1024, 1), square(64, 64);
    for (uint32_t i = 0; i < effort(1'000'000); ++i) {
      const Sampler sampler = at(i);
      line.add(static_cast<double>(sampler.template get_1d<Real>(dimension)));
      const Vec2<Real> u = sampler.template get_2d<Real>(dimension);
      square.add(static_cast<double>(u.x), static_cast<double>(u.y));
    }
    expect_uniform(line, what + ", dimension " + std::to_string(dimension));
    expect_uniform(square, what + ", pairs of dimension " + std::to_string(dimension));
  }
}

TYPED_TEST(SamplerUniformity, OverSamples) {
  check_uniform<float, TypeParam>([](uint32_t i) { return TypeParam(1, 37, 51, i); }, "samples of one pixel");
}

TYPED_TEST(SamplerUniformity, OverPixels) {
  check_uniform<double, TypeParam>([](uint32_t i) { return TypeParam(2, i % side, i / side, 0); }, "pixels");
}

/// Numbers of two dimensions, or of two neighbours, as coordinates of a point are uniform over the square too.
template <class Sampler, class At>
void check_uncorrelated(const At& at, const std::string& what) {
  for (const uint32_t last : last_dimensions) {
    UniformGrid following(64, 64), seconds(64, 64);
    for (uint32_t i = 0; i < effort(1'000'000); ++i) {
      const Sampler sampler = at(i);
      following.add(sampler.template get_1d<double>(last), sampler.template get_1d<double>(last + 1));
      seconds.add(sampler.template get_2d<double>(last).y, sampler.template get_2d<double>(last + 2).y);
    }
    expect_uniform(following, what + ", dimensions " + std::to_string(last) + " and the next");
    expect_uniform(seconds, what + ", second numbers of dimension " + std::to_string(last) + " and the next but one");
  }
}

/// Not for Sobol' points: those of one pixel are not independent, and nested shuffles, however random, pair dimensions
/// so that the statistic varies more than chi-squared.
TEST(IndependentUniformity, DimensionsOfOnePixel) {
  check_uncorrelated<IndependentSampler>([](uint32_t i) { return IndependentSampler(3, 5, 8, i); },
                                         "samples of one pixel");
}

TYPED_TEST(SamplerUniformity, DimensionsOverPixels) {
  check_uncorrelated<TypeParam>([](uint32_t i) { return TypeParam(4, i % side, i / side, 3); }, "sample 3 of pixels");
  check_uncorrelated<TypeParam>([](uint32_t i) { return TypeParam(4, i % side, i / side, 1000); },
                                "sample 1000 of pixels");
}

TYPED_TEST(SamplerUniformity, NeighboursAreUncorrelated) {
  UniformGrid right(64, 64), below(64, 64), seeds(64, 64), branches(64, 64);
  for (uint32_t i = 0; i < effort(1'000'000); ++i) {
    const uint32_t x = i % side, y = i / side;
    const TypeParam sampler(5, x, y, 2);
    const double u = sampler.template get_1d<double>(3);
    right.add(u, TypeParam(5, x + 1, y, 2).template get_1d<double>(3));
    below.add(u, TypeParam(5, x, y + 1, 2).template get_1d<double>(3));
    seeds.add(u, TypeParam(6, x, y, 2).template get_1d<double>(3));
    branches.add(sampler.fork(0).template get_1d<double>(3), sampler.fork(1).template get_1d<double>(3));
  }
  expect_uniform(right, "pixels side by side");
  expect_uniform(below, "pixels one above the other");
  expect_uniform(seeds, "two seeds");
  expect_uniform(branches, "two branches");
}

}  // namespace
}  // namespace alhazen::impl::test
