#include "scene/albedo_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "core/materials/albedo_table.h"
#include "core/materials/layered.h"

namespace alhazen {

namespace {

/// Where the values of a table lie; the first ones a little inside of what has no area or no direction.
double cosine_at(uint32_t i) { return std::max(sqr(static_cast<double>(i) / (albedo_side - 1)), 1e-4); }
double alpha_at(uint32_t j) {
  return std::max(sqr(static_cast<double>(j) / (albedo_side - 1)), least_layered_alpha<double>);
}

/// `albedo(direction, alpha)` at every value, and its means over all directions.
template <class Albedo>
std::vector<double> table_of(const Albedo& albedo) {
  std::vector<double> table(albedo_table_size);
#pragma omp parallel for schedule(dynamic)
  for (uint32_t j = 0; j < albedo_side; ++j)
    for (uint32_t i = 0; i < albedo_side; ++i) {
      const double cosine = cosine_at(i);
      table[j * albedo_side + i] = albedo(Vec3d{std::sqrt(1 - cosine * cosine), 0, cosine}, alpha_at(j));
    }
  constexpr int steps = 256;
  for (uint32_t j = 0; j < albedo_side; ++j) {
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
      // Midpoints by sqrt(cosine) = x: 2 cos d cos = 4 x^3 dx.
      const double x = (k + 0.5) / steps, place = x * (albedo_side - 1);
      const uint32_t i = std::min(static_cast<uint32_t>(place), albedo_side - 2);
      const double* row = table.data() + j * albedo_side + i;
      sum += (row[0] + (row[1] - row[0]) * (place - i)) * 4 * x * x * x / steps;
    }
    table[albedo_side * albedo_side + j] = sum;
  }
  return table;
}

/// Mean of weight(cosine at the microfacet) over what GGX of that alpha reflects, by strata of its visible normals.
template <class Weight>
double reflected_share(const Vec3d& o, double alpha, const Weight& weight) {
  constexpr int strata = 24;
  double sum = 0;
  for (int a = 0; a < strata; ++a)
    for (int b = 0; b < strata; ++b) {
      const Vec3d m = sample_visible_normal(o, alpha, Vec2d{(a + 0.5) / strata, (b + 0.5) / strata});
      const double cosine = dot(o, m);
      const Vec3d i = m * (2 * cosine) - o;
      if (i.z > 0 && cosine > 0) sum += weight(cosine) * ggx_g2(o, i, alpha) / ggx_g1(o, alpha);
    }
  return sum / (strata * strata);
}

/// Albedo of sheen of colour 1, by midpoints over the hemisphere.
double sheen_share(const Vec3d& o, double alpha) {
  constexpr int rings = 40, sectors = 40;
  const double roughness = std::max(std::sqrt(alpha), 0.07);
  double sum = 0;
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double angle = (r + 0.5) / rings * pi<double> / 2, turn = (s + 0.5) / sectors * pi<double>;
      const Vec3d i{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
      sum += evaluate_sheen(roughness, o, i) * std::sin(angle);
    }
  return sum * 2 * (pi<double> / 2 / rings) * (pi<double> / sectors);
}

void append(std::vector<double>& all, const std::vector<double>& table) {
  all.insert(all.end(), table.begin(), table.end());
}

std::vector<double> make_common_tables() {
  std::vector<double> all;
  append(all, table_of([](const Vec3d& o, double alpha) {
           return reflected_share(o, alpha, [](double cosine) { return 1 - schlick_share(cosine); });
         }));
  append(all, table_of([](const Vec3d& o, double alpha) {
           return reflected_share(o, alpha, [](double cosine) { return schlick_share(cosine); });
         }));
  append(all, table_of(sheen_share));
  return all;
}

}  // namespace

const std::vector<double>& common_albedo_tables() {
  static const std::vector<double> all = make_common_tables();
  return all;
}

const std::vector<double>& interface_albedo_table(double ior) {
  static std::mutex mutex;
  static std::map<double, std::vector<double>> tables;
  const std::lock_guard lock(mutex);
  std::vector<double>& table = tables[ior];
  if (!table.empty()) return table;
  table = table_of([ior](const Vec3d& o, double alpha) {
    return reflected_share(o, alpha, [ior](double cosine) {
      double cos_t;
      return fresnel_dielectric(cosine, ior, cos_t);
    });
  });
  return table;
}

double inner_diffuse_reflectance(double ior, double optical_thickness) {
  constexpr int steps = 4096;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double cosine = (k + 0.5) / steps;
    double cos_t;
    sum += 2 * cosine * fresnel_dielectric(cosine, 1 / ior, cos_t) * std::exp(-2 * optical_thickness / cosine) / steps;
  }
  return sum;
}

}  // namespace alhazen
