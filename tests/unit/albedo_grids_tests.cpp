// Grids of albedo: those of alphas that vary hold the constant ones, whichever alpha is the larger.

#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/layered.h"
#include "scene/albedo_grids.h"

namespace alhazen::test {
namespace {

double ggx_share(const AlbedoGrid& grid, const Vec2d& alpha, const Vec3d& o) {
  const Table values = values_of(grid);
  return ggx_albedo(grid_place(values->data(), record_of(grid), alpha), o).all();
}

TEST(AlbedoGrids, PairsThatVaryHoldTheConstantOnes) {
  const AlbedoGrid varying{.is_anisotropic = true};
  const Vec2d alpha{std::pow(6.0 / 11, 2), std::pow(3.0 / 11, 2)}, turned{alpha.y, alpha.x};  // nodes
  for (const double cosine : {0.9, 0.5, 0.1})
    for (const double azimuth : {0.0, 0.5, 1.2, 1.57}) {
      const double sine = std::sqrt(1 - cosine * cosine), x = sine * std::cos(azimuth), y = sine * std::sin(azimuth);
      const AlbedoGrid constant{.is_anisotropic = true, .alpha_u = alpha.x, .alpha_v = alpha.y};
      const double share = ggx_share(constant, alpha, {x, y, cosine});
      EXPECT_NEAR(ggx_share(varying, alpha, {x, y, cosine}), share, 0.006) << cosine << " " << azimuth;
      EXPECT_NEAR(ggx_share(varying, turned, {y, x, cosine}), share, 0.006) << cosine << " " << azimuth;
      EXPECT_LT(share, 1.001);
    }
}

TEST(AlbedoGrids, AreComputedOnce) {
  const AlbedoGrid grid{.alpha_u = 0.3, .alpha_v = 0.3};
  EXPECT_EQ(values_of(grid), values_of(grid));
  EXPECT_NE(values_of(grid), values_of({.alpha_u = 0.4, .alpha_v = 0.4}));
}

}  // namespace
}  // namespace alhazen::test
