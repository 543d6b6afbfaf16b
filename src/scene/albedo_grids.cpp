#include "scene/albedo_grids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/materials/layered.h"
#include "scene/albedo_quadrature.h"

namespace alhazen {

namespace {

constexpr uint32_t max_quantities = 6;
using Quantities = std::array<double, max_quantities>;

uint32_t quantities_of(AlbedoGrid::Kind kind) {
  return kind == AlbedoGrid::Kind::glass ? GlassGrid::count : kind == AlbedoGrid::Kind::sheen ? 1 : 2;
}

/// The index beyond the interface on the side where a quantity is seen from.
double index_of(const AlbedoGrid& grid, uint32_t quantity) {
  if (grid.kind == AlbedoGrid::Kind::ggx || grid.kind == AlbedoGrid::Kind::sheen) return 1;
  return grid.kind == AlbedoGrid::Kind::glass && quantity >= GlassGrid::from_within ? 1 / grid.ior : grid.ior;
}

/// The azimuth of a node, as grid_direction has it.
Vec2d azimuth_of_node(uint32_t node, uint32_t azimuths) {
  if (azimuths == 1) return {1, 0};
  const double t = 0.5 * (1 - std::cos(pi<double> * node / (azimuths - 1)));
  const double length = std::sqrt(t * t + (1 - t) * (1 - t));
  return {t / length, (1 - t) / length};
}

/// base and edge of GGX whose Fresnel term is Schlick's.
void add_ggx(const Vec3d& o, const Vec2d& alpha, int count, Quantities& q) {
  for_visible_normals(o, alpha, count, Strata::dense_in_tails, [&](const Vec3d& m, double weight) {
    const double cosine = dot(o, m);
    const Vec3d i = m * (2 * cosine) - o;
    if (!(i.z > 0 && cosine > 0)) return;
    const double reflected = weight * ggx_g2(o, i, alpha) / ggx_g1(o, alpha), edge = schlick_share(cosine);
    q[GgxGrid::base] += reflected * (1 - edge);
    q[GgxGrid::edge] += reflected * edge;
  });
}

/// The quantities of glass on one side, `eta` being the index of the other one relative to it.
void add_glass(const Vec3d& o, const Vec2d& alpha, double eta, int count, double* q) {
  for_visible_normals(o, alpha, count, Strata::dense_in_tails, [&](const Vec3d& m, double weight) {
    const double cosine = dot(o, m);
    if (!(cosine > 0)) return;
    double cos_t;
    const double fresnel = fresnel_dielectric(cosine, eta, cos_t), scale = weight / ggx_g1(o, alpha);
    const Vec3d r = m * (2 * cosine) - o;
    const double reflected = r.z > 0 ? scale * ggx_g2(o, r, alpha) : 0;
    if (fresnel >= 1) {
      q[GlassGrid::bare] += reflected;
      return;
    }
    const Vec3d t = m * (cosine / eta - cos_t) - o * (1 / eta);
    const double refracted = t.z < 0 ? scale * ggx_g2(o, t, alpha) : 0;
    q[GlassGrid::bare] += refracted;
    q[GlassGrid::by_fresnel] += fresnel * (reflected - refracted);
    q[GlassGrid::by_constant] += reflected - refracted;
  });
}

void add_coat(const AlbedoGrid& grid, const Vec3d& o, const Vec2d& alpha, int count, Quantities& q) {
  q[CoatGrid::interface] = reflected_share(
      o, alpha, Strata::dense_in_tails,
      [&](double cosine, double) {
        double cos_t;
        return fresnel_dielectric(cosine, grid.ior, cos_t);
      },
      count);
  if (!grid.conserves) {
    q[CoatGrid::transmission] = transmitted_share(o, alpha, grid.ior, grid.thickness, count);
    return;
  }
  q[CoatGrid::transmission] = (1 - q[CoatGrid::interface]) * std::exp(-grid.thickness / cosine_in_coat(o.z, grid.ior));
}

/// Albedo of sheen of colour 1, by midpoints over the hemisphere, which are dense along the horizon.
double sheen_albedo(const Vec3d& o, double alpha) {
  constexpr int rings = 64, sectors = 64;
  const double roughness = std::max(std::sqrt(alpha), 0.07);
  double sum = 0;
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double rest = 1 - (r + 0.5) / rings, turn = (s + 0.5) / sectors * pi<double>;
      const double angle = (1 - rest * rest) * pi<double> / 2;
      const Vec3d i{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
      sum += evaluate_sheen(roughness, o, i) * std::sin(angle) * 2 * rest;
    }
  return sum * 2 * (pi<double> / 2 / rings) * (pi<double> / sectors);
}

/// What quantities of a direction are computed together: those whose nodes have the same cosines.
void add_side(const AlbedoGrid& grid, uint32_t first, const Vec3d& o, const Vec2d& alpha, int count, Quantities& q) {
  switch (grid.kind) {
    case AlbedoGrid::Kind::ggx:
      return add_ggx(o, alpha, count, q);
    case AlbedoGrid::Kind::coat:
      return add_coat(grid, o, alpha, count, q);
    case AlbedoGrid::Kind::sheen:
      q[0] = sheen_albedo(o, alpha.x);
      return;
    case AlbedoGrid::Kind::glass:
      return add_glass(o, alpha, index_of(grid, first), count, q.data() + first);
  }
}

/// Mean of a quantity over all directions, from its rows.
double mean_of(const double* rows, uint32_t azimuths, double ior) {
  if (azimuths == 1) return mean_of_row(rows, ior, grid_cosines);
  const AlbedoGridPlace<double> place{rows, 1, azimuths, 0, 0, 0, 0};
  constexpr int turns = 16;
  double sum = 0;
  for (int t = 0; t < turns; ++t) {
    const double turn = (t + 0.5) / turns * pi<double> / 2;
    sum += mean_over_cosines(ior, [&](double cosine) {
      const double sine = safe_sqrt(1 - cosine * cosine);
      const Vec3d o{sine * std::cos(turn), sine * std::sin(turn), cosine};
      return grid_albedo(place, 0, grid_direction(place, o, ior));
    });
  }
  return sum / turns;
}

void fill_block(const AlbedoGrid& grid, const AlbedoGridRecord& record, const Vec2d& alpha, int count, double* block) {
  const uint32_t sides = grid.kind == AlbedoGrid::Kind::glass ? 2 : 1, each = record.quantities / sides;
  for (uint32_t first = 0; first < record.quantities; first += each)
    for (uint32_t a = 0; a < record.azimuths; ++a)
      for (uint32_t i = 0; i < grid_cosines; ++i) {
        const double cosine = cosine_at(i, index_of(grid, first), grid_cosines), sine = safe_sqrt(1 - cosine * cosine);
        const Vec2d azimuth = azimuth_of_node(a, record.azimuths);
        Quantities q{};
        add_side(grid, first, {sine * azimuth.x, sine * azimuth.y, cosine}, alpha, count, q);
        for (uint32_t k = first; k < first + each; ++k) block[(k * record.azimuths + a) * grid_cosines + i] = q[k];
      }
  if (grid.kind == AlbedoGrid::Kind::glass || grid.kind == AlbedoGrid::Kind::sheen) return;  // nobody asks for means
  for (uint32_t k = 0; k < record.quantities; ++k)
    block[record.quantities * record.azimuths * grid_cosines + k] =
        mean_of(block + k * record.azimuths * grid_cosines, record.azimuths, index_of(grid, k));
}

double alpha_of_node(const std::optional<double>& constant, uint32_t node, uint32_t alphas) {
  const double alpha = constant ? *constant : sqr(static_cast<double>(node) / (alphas - 1));
  return std::clamp(alpha, least_layered_alpha<double>, 1.0);
}

}  // namespace

bool AlbedoGrid::operator<(const AlbedoGrid& other) const {
  return std::tie(kind, ior, is_anisotropic, alpha_u, alpha_v, thickness, conserves) <
         std::tie(other.kind, other.ior, other.is_anisotropic, other.alpha_u, other.alpha_v, other.thickness,
                  other.conserves);
}

AlbedoGridRecord record_of(const AlbedoGrid& grid) {
  const bool constant = grid.alpha_u && (grid.alpha_v || !grid.is_anisotropic);
  AlbedoGridRecord record{0, quantities_of(grid.kind), grid.is_anisotropic ? grid_azimuths : 1, 1, 1};
  if (constant) return record;
  if (grid.is_anisotropic) record.azimuths = grid_azimuths_of_pairs;
  record.alphas_u = grid.is_anisotropic ? grid_alpha_pairs : grid_alphas;
  record.alphas_v = grid.is_anisotropic ? grid_alpha_pairs : 1;
  return record;
}

namespace {

std::vector<double> computed(const AlbedoGrid& grid) {
  const AlbedoGridRecord record = record_of(grid);
  const uint32_t size = grid_block_size(record.quantities, record.azimuths), blocks = record.alphas_u * record.alphas_v;
  const int count = blocks == 1 ? 48 : grid.is_anisotropic ? 16 : 24;
  const bool constant = blocks == 1;
  std::vector<double> values(static_cast<size_t>(size) * blocks);
#pragma omp parallel for schedule(dynamic)
  for (uint32_t n = 0; n < blocks; ++n) {
    const double u = alpha_of_node(constant ? grid.alpha_u : std::nullopt, n / record.alphas_v, record.alphas_u);
    const double v = !grid.is_anisotropic
                         ? u
                         : alpha_of_node(constant ? grid.alpha_v : std::nullopt, n % record.alphas_v, record.alphas_v);
    fill_block(grid, record, {u, v}, count, values.data() + static_cast<size_t>(n) * size);
  }
  return values;
}

}  // namespace

std::vector<double> values_of(const AlbedoGrid& grid) {
  // That of every principled material without anisotropy.
  static const std::vector<double> isotropic = computed({.kind = AlbedoGrid::Kind::ggx});
  const bool is_common = grid.kind == AlbedoGrid::Kind::ggx && !grid.is_anisotropic && !grid.alpha_u;
  return is_common ? isotropic : computed(grid);
}

}  // namespace alhazen
