// Samples of sample_bsdf against the density of evaluate_bsdf: a chi-squared test over bins of the sphere.

#include <gtest/gtest.h>

#include "support/bsdfs.h"
#include "support/density_check.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

constexpr double diffuse_alphas[] = {0};
constexpr double metal_alphas[] = {0.05, 0.3, 0.8};
constexpr double glass_alphas[] = {0.1, 0.3, 0.6};
constexpr size_t cases =
    2 * std::size(cosines) * (std::size(diffuse_alphas) + std::size(metal_alphas) + 2 * std::size(glass_alphas));

template <class Real>
void check_sampling(const NamedBsdf<Real>& named, double cosine, uint64_t seed) {
  const Bsdf<Real>& bsdf = named.bsdf;
  const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.7);
  Random random(seed);
  check_density(bsdf, wo, random, cases, named.name + ", cosine " + std::to_string(cosine), 1'000'000, 1e-3);
}

template <class Real>
class BsdfSampling : public ::testing::Test {};
TYPED_TEST_SUITE(BsdfSampling, Reals);

TYPED_TEST(BsdfSampling, Diffuse) {
  for (const double cosine : cosines) check_sampling(diffuse_bsdf<TypeParam>(0.7), cosine, 1);
}

TYPED_TEST(BsdfSampling, Metal) {
  for (const double alpha : metal_alphas)
    for (const double cosine : cosines) check_sampling(metal_bsdf<TypeParam>(alpha), cosine, 2);
}

TYPED_TEST(BsdfSampling, GlassFromOutside) {
  for (const double alpha : glass_alphas)
    for (const double cosine : cosines) check_sampling(glass_bsdf<TypeParam>(alpha), cosine, 3);
}

TYPED_TEST(BsdfSampling, GlassFromInside) {
  for (const double alpha : glass_alphas)
    for (const double cosine : cosines) check_sampling(glass_bsdf<TypeParam>(alpha), -cosine, 4);
}

}  // namespace
}  // namespace alhazen::impl::test
