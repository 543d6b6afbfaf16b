// Grids of albedo: those of varying alphas contain the constant ones, whichever alpha is larger.

#include <gtest/gtest.h>

#include <cmath>

#include "compile/tables/albedo_grids.h"
#include "compile/tables/albedo_quadrature.h"
#include "compile/tables/albedo_tables.h"
#include "core/materials/lobes/ggx_albedo.h"

namespace alhazen::impl::test {
namespace {

double ggx_fraction(const AlbedoGrid& grid, const Vec2d& alpha, const Vec3d& o) {
  const Table values = values_of(grid);
  return ggx_albedo(grid_place(values->data(), record_of(grid), alpha), o).all();
}

TEST(AlbedoGrids, PairsThatVaryHoldTheConstantOnes) {
  const AlbedoGrid varying{.is_anisotropic = true};
  const Vec2d alpha{alpha_at(6, grid_alpha_pairs), alpha_at(3, grid_alpha_pairs)}, turned{alpha.y, alpha.x};
  for (const double cosine : {0.9, 0.5, 0.1})
    for (const double azimuth : {0.0, 0.5, 1.2, 1.57}) {
      const double sine = std::sqrt(1 - cosine * cosine), x = sine * std::cos(azimuth), y = sine * std::sin(azimuth);
      const AlbedoGrid constant{.is_anisotropic = true, .alpha_u = alpha.x, .alpha_v = alpha.y};
      const double fraction = ggx_fraction(constant, alpha, {x, y, cosine});
      EXPECT_NEAR(ggx_fraction(varying, alpha, {x, y, cosine}), fraction, 0.006) << cosine << " " << azimuth;
      EXPECT_NEAR(ggx_fraction(varying, turned, {y, x, cosine}), fraction, 0.006) << cosine << " " << azimuth;
      EXPECT_LT(fraction, 1.001);
    }
}

TEST(AlbedoGrids, AreComputedOnce) {
  const AlbedoGrid grid{.alpha_u = 0.3, .alpha_v = 0.3};
  EXPECT_EQ(values_of(grid), values_of(grid));
  EXPECT_NE(values_of(grid), values_of({.alpha_u = 0.4, .alpha_v = 0.4}));
}

// Beyond the critical angle a nearly smooth interface changes to total reflection within its alpha.
TEST(AlbedoTables, FollowTheEdgeOfTotalReflection) {
  const VisibleNormals seen(4096, Density::even);
  for (const double ior : {0.1, 0.5, 0.9}) {
    const Table table = interface_albedo_table(ior);
    const Vec2d alpha{min_layered_alpha<double>, min_layered_alpha<double>};
    double worst = 0, sum = 0;
    constexpr int directions = 2000;
    for (int k = 1; k < directions; ++k) {
      // Evenly over the cone that light enters from and as much again beyond it.
      const double cosine = std::sqrt(1 - std::min(1.0, 2 * ior * ior) * k / directions);
      const double exact =
          reflected_fraction(seen, {std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, [&](double c, double) {
            double cos_t;
            return fresnel_dielectric(c, ior, cos_t);
          });
      const double error = std::abs(lookup_albedo(table->data(), cosine, alpha.x, ior) - exact);
      worst = std::max(worst, error);
      sum += error;
    }
    EXPECT_LT(worst, 0.1) << ior;
    EXPECT_LT(sum / directions, 0.005) << ior;
  }
}

}  // namespace
}  // namespace alhazen::impl::test
