#include "compile/tables/albedo_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "compile/tables/albedo_quadrature.h"
#include "core/materials/lobes/albedo_table.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"

namespace alhazen::impl {

namespace {

constexpr size_t normals = 377;

/// Tabulates `albedo(direction, alphas)` and its means over all directions, for an interface of index `ior`.
template <class Albedo>
std::vector<double> table_of(const Albedo& albedo, double ior) {
  std::vector<double> table(albedo_table_size);
#pragma omp parallel for schedule(dynamic)
  for (uint32_t j = 0; j < albedo_side; ++j)
    for (uint32_t i = 0; i < albedo_side; ++i) {
      const double cosine = cosine_at(i, ior, albedo_side), alpha = alpha_at(j, albedo_side);
      table[j * albedo_side + i] = albedo(Vec3d{std::sqrt(1 - cosine * cosine), 0, cosine}, Vec2d{alpha, alpha});
    }
  for (uint32_t j = 0; j < albedo_side; ++j)
    table[albedo_side * albedo_side + j] = mean_of_row(table.data() + j * albedo_side, ior, albedo_side);
  return table;
}

/// Fraction of diffuse light from below that the interface reflects down, after travelling up and down the medium.
double inner_reflectance(const VisibleNormals& seen, double ior, double alpha, double optical_thickness) {
  const bool smooth = alpha <= min_layered_alpha<double>;
  const int steps = smooth ? 4096 : 96;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double cosine = (k + 0.5) / steps;
    const auto reflected = [&](double cos_o, double cos_i) {
      double cos_t;
      return fresnel_dielectric(cos_o, 1 / ior, cos_t) * std::exp(-optical_thickness * (1 / cosine + 1 / cos_i));
    };
    const Vec3d o{std::sqrt(1 - cosine * cosine), 0, cosine};
    sum += 2 * cosine *
           (smooth ? reflected(cosine, cosine) : reflected_fraction(seen, o, Vec2d{alpha, alpha}, reflected)) / steps;
  }
  return sum;
}

std::vector<double> interface_albedo(double ior) {
  // Glass and water reflect next to nothing from the tails of GGX.
  const VisibleNormals seen(normals, ior >= 1 && ior <= 2 ? Density::even : Density::dense_in_tails);
  return table_of(
      [&](const Vec3d& o, const Vec2d& alpha) {
        return reflected_fraction(seen, o, alpha, [ior](double cosine, double) {
          double cos_t;
          return fresnel_dielectric(cosine, ior, cos_t);
        });
      },
      ior);
}

double* column(std::vector<double>& table, uint32_t column) {
  return table.data() + (albedo_side + column) * albedo_side;
}

/// The interface transmits all that it does not reflect.
std::vector<double> conserving_transmission(double ior, double optical_thickness) {
  const VisibleNormals seen(normals, Density::even);
  std::vector<double> table = *interface_albedo_table(ior);
  table.resize(coat_transmission_size);
  const double unabsorbed = inner_reflectance(seen, ior, 0, 0);
  const double kept = unabsorbed > 0 ? inner_reflectance(seen, ior, 0, optical_thickness) / unabsorbed : 1;
  for (uint32_t j = 0; j < albedo_side; ++j) {
    double* row = table.data() + j * albedo_side;
    std::array<double, albedo_side> entering;
    for (uint32_t i = 0; i < albedo_side; ++i) {
      entering[i] = 1 - row[i];
      row[i] = (1 - row[i]) * std::exp(-optical_thickness / cosine_in_coat(cosine_at(i, ior, albedo_side), ior));
    }
    // Diffuse light leaves as it enters, divided by the square of the index, but no more than all of it.
    const double mean = mean_of_row(entering.data(), ior, albedo_side);
    double* back = column(table, CoatColumns::back) + j;
    *back = std::max(0.0, 1 - (ior >= 1 ? 1 - *back : mean) / (ior * ior)) * kept;
    column(table, CoatColumns::escape)[j] = 1 - (1 - std::min(1.0, mean / (ior * ior))) * kept;
    column(table, CoatColumns::scale)[j] = mean > ior * ior ? ior * ior / mean : 1;
    column(table, CoatColumns::mean)[j] = mean_of_row(row, ior, albedo_side);
  }
  return table;
}

/// The transmission of single scattering at the interface.
std::vector<double> lossy_transmission(double ior, double optical_thickness) {
  const VisibleNormals seen(normals, Density::even);
  std::vector<double> table = table_of(
      [&](const Vec3d& o, const Vec2d& alpha) { return transmitted_fraction(seen, o, alpha, ior, optical_thickness); },
      ior);
  table.resize(coat_transmission_size);
#pragma omp parallel for schedule(dynamic)
  for (uint32_t j = 0; j < albedo_side; ++j) {
    const double mean = column(table, CoatColumns::mean)[j] =
        mean_of_row(table.data() + j * albedo_side, ior, albedo_side);
    const double back = inner_reflectance(seen, ior, alpha_at(j, albedo_side), optical_thickness);
    column(table, CoatColumns::back)[j] = back;
    column(table, CoatColumns::escape)[j] = 1 - back;
    // Below an index of 1 an error of the mean would be amplified.
    const double leaving = ior * ior * (1 - back);
    column(table, CoatColumns::scale)[j] = ior < 1 && mean > leaving ? leaving / mean : 1;
  }
  return table;
}

}  // namespace

Table interface_albedo_table(double ior) {
  static TableCache<double> cache;
  return cache.get(ior, [&] { return interface_albedo(ior); });
}

Table coat_transmission_table(double ior, double optical_thickness, bool conserves) {
  static TableCache<std::tuple<double, double, bool>> cache;
  return cache.get({ior, optical_thickness, conserves}, [&] {
    return conserves ? conserving_transmission(ior, optical_thickness) : lossy_transmission(ior, optical_thickness);
  });
}

}  // namespace alhazen::impl
