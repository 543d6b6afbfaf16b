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

/// Mean of share(normal) over the normals of GGX of that alpha that are seen from `o`, by strata.
template <class Share>
double mean_over_visible_normals(const Vec3d& o, double alpha, const Share& share) {
  constexpr int strata = 24;
  double sum = 0;
  for (int a = 0; a < strata; ++a)
    for (int b = 0; b < strata; ++b)
      sum += share(sample_visible_normal(o, alpha, Vec2d{(a + 0.5) / strata, (b + 0.5) / strata}));
  return sum / (strata * strata);
}

/// Mean of weight(cosine at the microfacet, that of the way on) over what GGX of that alpha reflects.
template <class Weight>
double reflected_share(const Vec3d& o, double alpha, const Weight& weight) {
  return mean_over_visible_normals(o, alpha, [&](const Vec3d& m) {
    const double cosine = dot(o, m);
    const Vec3d i = m * (2 * cosine) - o;
    return i.z > 0 && cosine > 0 ? weight(cosine, i.z) * ggx_g2(o, i, alpha) / ggx_g1(o, alpha) : 0;
  });
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

/// Share of light from `o` that single scattering at a rough interface lets through to what lies below a medium.
double transmitted_share(const Vec3d& o, double alpha, double ior, double optical_thickness) {
  return mean_over_visible_normals(o, alpha, [&](const Vec3d& m) {
    const double cosine = dot(o, m);
    double cos_t;
    const double passes = cosine > 0 ? 1 - fresnel_dielectric(cosine, ior, cos_t) : 0;
    if (passes == 0) return 0.0;
    const Vec3d i = m * (cosine / ior - cos_t) - o * (1 / ior);
    return i.z < 0 ? passes * std::exp(optical_thickness / i.z) * ggx_g2(o, i, alpha) / ggx_g1(o, alpha) : 0;
  });
}

/// Share of diffuse light from below that the interface sends down again, after a way up and one down.
double inner_reflectance(double ior, double alpha, double optical_thickness) {
  const bool smooth = alpha <= least_layered_alpha<double>;
  const int steps = smooth ? 4096 : 96;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double cosine = (k + 0.5) / steps;
    const auto reflected = [&](double cos_o, double cos_i) {
      double cos_t;
      return fresnel_dielectric(cos_o, 1 / ior, cos_t) * std::exp(-optical_thickness * (1 / cosine + 1 / cos_i));
    };
    const Vec3d o{std::sqrt(1 - cosine * cosine), 0, cosine};
    sum += 2 * cosine * (smooth ? reflected(cosine, cosine) : reflected_share(o, alpha, reflected)) / steps;
  }
  return sum;
}

void append(std::vector<double>& all, const std::vector<double>& table) {
  all.insert(all.end(), table.begin(), table.end());
}

std::vector<double> make_common_tables() {
  std::vector<double> all;
  append(all, table_of([](const Vec3d& o, double alpha) {
           return reflected_share(o, alpha, [](double cosine, double) { return 1 - schlick_share(cosine); });
         }));
  append(all, table_of([](const Vec3d& o, double alpha) {
           return reflected_share(o, alpha, [](double cosine, double) { return schlick_share(cosine); });
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
    return reflected_share(o, alpha, [ior](double cosine, double) {
      double cos_t;
      return fresnel_dielectric(cosine, ior, cos_t);
    });
  });
  return table;
}

std::vector<double> coat_transmission_table(double ior, double optical_thickness, bool conserves) {
  std::vector<double> table;
  double* back = nullptr;
  if (conserves) {
    table = interface_albedo_table(ior);
    back = table.data() + albedo_side * albedo_side;
    for (uint32_t i = 0; i < albedo_side * albedo_side; ++i) {
      const double inside = cosine_within(cosine_at(i % albedo_side), ior);
      table[i] = inside > 0 ? (1 - table[i]) * std::exp(-optical_thickness / inside) : 0;
    }
    // Diffuse light leaves by as much as it enters, over the square of the index.
    const double absorbed = inner_reflectance(ior, 0, optical_thickness) / inner_reflectance(ior, 0, 0);
    for (uint32_t j = 0; j < albedo_side; ++j) back[j] = std::max(0.0, 1 - (1 - back[j]) / (ior * ior)) * absorbed;
  } else {
    table = table_of([&](const Vec3d& o, double alpha) { return transmitted_share(o, alpha, ior, optical_thickness); });
    back = table.data() + albedo_side * albedo_side;
#pragma omp parallel for schedule(dynamic)
    for (uint32_t j = 0; j < albedo_side; ++j) back[j] = inner_reflectance(ior, alpha_at(j), optical_thickness);
  }
  return table;
}

}  // namespace alhazen
