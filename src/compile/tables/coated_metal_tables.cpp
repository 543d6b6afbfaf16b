#include "compile/tables/coated_metal_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "compile/tables/albedo_quadrature.h"
#include "core/materials/dielectric.h"
#include "core/materials/lobes/coated_metal.h"
#include "core/sampling/hash.h"

namespace alhazen::impl {

namespace {

using Row = std::array<double, coated_metal_cosines>;

Vec3d direction_at(size_t i, double ior) {
  const double cosine = std::max(cosine_at(static_cast<uint32_t>(i), ior, coated_metal_cosines), 1e-3);
  return {std::sqrt(1 - cosine * cosine), 0, cosine};
}

/// Random numbers of walk `index`, the same for every direction, so that the rows are smooth.
class Numbers {
 public:
  explicit Numbers(uint64_t index) : state_(mix64(index + 1)) {}
  Vec2d pair() { return {next(), next()}; }

 private:
  double next() {
    state_ += 0x9e3779b97f4a7c15;
    return static_cast<double>(mix64(state_) >> 11) * 0x1p-53;
  }
  uint64_t state_;
};

/// Light that leaves the coat after one bounce off the metal, and after any number.
struct Left {
  double once = 0, all = 0;
};

/// A random walk of light that enters from `o`; at the interface it follows both branches: out, and down again.
Left walk(const CoatedMetal& coat, double coat_alpha, double metal_alpha, const Vec3d& o, Numbers numbers) {
  Left left;
  const DielectricBsdf<double> interface { coat.ior, coat_alpha };
  const DielectricBranches<double> entry = dielectric_branches(interface, o, numbers.pair());
  if (!(entry.refracted.pdf > 0)) return left;
  double weight = (1 - entry.reflected_rate) * entry.refracted.weight.x;
  Vec3d direction = entry.refracted.direction;
  const int bounces = coat.bounces > 0 ? coat.bounces : 64;
  for (int bounce = 0; bounce < bounces && weight > 1e-5; ++bounce) {
    const Vec3d down = -direction, m = sample_visible_normal(down, metal_alpha, numbers.pair());
    const Vec3d up = m * (2 * dot(down, m)) - down;
    if (!(up.z > 0)) break;
    weight *=
        ggx_g2(down, up, metal_alpha) / ggx_g1(down, metal_alpha) * std::exp(-coat.thickness * (1 / down.z + 1 / up.z));
    const DielectricBranches<double> exit = dielectric_branches(interface, -up, numbers.pair());
    if (exit.refracted.pdf > 0) {
      const double out = weight * (1 - exit.reflected_rate) * exit.refracted.weight.x;
      left.all += out;
      if (bounce == 0) left.once += out;
    }
    if (!(exit.reflected.pdf > 0)) break;
    weight *= coated_metal_fit<double> * exit.reflected_rate * exit.reflected.weight.x;
    direction = exit.reflected.direction;
  }
  return left;
}

/// A direction into which GGX reflects light, and how much of it.
struct Reflected {
  double cosine, weight;
};

constexpr int lobe_strata = 24;

/// Adds at most lobe_strata^2 of them to `lobe`.
void add_lobe(const Vec3d& o, double alpha, std::vector<Reflected>& lobe) {
  constexpr int strata = lobe_strata;
  for (int a = 0; a < strata; ++a)
    for (int b = 0; b < strata; ++b) {
      // At random in its stratum: midpoints would miss the tail of the distribution.
      const Vec2d u = Numbers(static_cast<uint64_t>(a * strata + b)).pair();
      const Vec3d m = sample_visible_normal(o, alpha, Vec2d{(a + u.x) / strata, (b + u.y) / strata});
      const Vec3d i = m * (2 * dot(o, m)) - o;
      if (i.z > 0) lobe.push_back({i.z, ggx_g2(o, i, alpha) / ggx_g1(o, alpha) / (strata * strata)});
    }
}

/// Albedo of the lobe, scaled for its directions but not for its own.
double scaled_albedo(const std::vector<Reflected>& lobe, const Row& scales, double ior) {
  double sum = 0;
  for (const Reflected& r : lobe) sum += r.weight * coated_metal_value(scales.data(), r.cosine, ior);
  return sum;
}

/// Scales s for which the lobe times s(o) s(i) has the wanted albedo (Sinkhorn balancing). At the horizon a narrow lobe
/// may need unbounded scales, and interpolation between nodes would then create energy.
Row scales_for(const Row& wanted, const std::vector<std::vector<Reflected>>& lobes, double ior) {
  constexpr double max_scale = 2;
  Row scales;
  scales.fill(1);
  for (int round = 0; round < 60; ++round)
    for (size_t k = 0; k < scales.size(); ++k) {
      const double sum = scaled_albedo(lobes[k], scales, ior);
      if (sum > 0) scales[k] = std::min(max_scale, std::sqrt(scales[k] * wanted[k] / sum));
    }
  for (size_t k = 0; k < scales.size(); ++k) {
    const double sum = scales[k] * scaled_albedo(lobes[k], scales, ior);
    if (sum > 1.002 * wanted[k]) scales[k] *= wanted[k] / sum;
  }
  return scales;
}

void add_block(const CoatedMetal& coat, double coat_alpha, double metal_alpha, uint64_t walks, double* block) {
  Row once{}, all{};
  std::vector<std::vector<Reflected>> lobes(coated_metal_cosines);
  // Allocated before the parallel loop: running out of memory inside it would end the process.
  for (std::vector<Reflected>& lobe : lobes) lobe.reserve(lobe_strata * lobe_strata);
#pragma omp parallel for schedule(dynamic)
  for (size_t k = 0; k < coated_metal_cosines; ++k) {
    for (uint64_t i = 0; i < walks; ++i) {
      const Left left = walk(coat, coat_alpha, metal_alpha, direction_at(k, coat.ior), Numbers(i));
      once[k] += left.once / static_cast<double>(walks);
      all[k] += left.all / static_cast<double>(walks);
    }
    add_lobe(direction_at(k, coat.ior), coated_metal_alpha(coat_alpha, metal_alpha, coat.ior), lobes[k]);
  }
  const Row first = scales_for(once, lobes, coat.ior), second = scales_for(all, lobes, coat.ior);
  std::copy(first.begin(), first.end(), block);
  std::copy(second.begin(), second.end(), block + coated_metal_cosines);
}

std::vector<double> alphas_of(const std::optional<double>& alpha) {
  if (alpha) return {std::clamp(*alpha, min_layered_alpha<double>, 1.0)};
  std::vector<double> all;
  for (uint32_t i = 0; i < coated_metal_alphas; ++i) all.push_back(alpha_at(i, coated_metal_alphas));
  return all;
}

std::vector<double> computed(const CoatedMetal& coat) {
  const std::vector<double> coat_alphas = alphas_of(coat.coat_alpha), metal_alphas = alphas_of(coat.metal_alpha);
  std::vector<double> table(coat_alphas.size() * metal_alphas.size() * coated_metal_block);
  double* block = table.data();
  for (const double coat_alpha : coat_alphas)
    for (const double metal_alpha : metal_alphas) {
      add_block(coat, coat_alpha, metal_alpha, coat_alphas.size() * metal_alphas.size() > 1 ? 1024 : 4096, block);
      block += coated_metal_block;
    }
  return table;
}

}  // namespace

bool CoatedMetal::operator<(const CoatedMetal& other) const {
  return std::tie(ior, coat_alpha, metal_alpha, thickness, bounces) <
         std::tie(other.ior, other.coat_alpha, other.metal_alpha, other.thickness, other.bounces);
}

Table coated_metal_table(const CoatedMetal& coat) {
  static TableCache<CoatedMetal> cache;
  return cache.get(coat, [&] { return computed(coat); });
}

}  // namespace alhazen::impl
