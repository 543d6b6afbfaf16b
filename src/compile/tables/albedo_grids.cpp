#include "compile/tables/albedo_grids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "compile/tables/albedo_quadrature.h"
#include "core/materials/coated_diffuse.h"
#include "core/materials/lobes/ggx_albedo.h"
#include "core/materials/lobes/glass_albedo.h"
#include "core/materials/lobes/sheen.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t max_quantities = 8;
using Quantities = std::array<double, max_quantities>;

struct GridNormals {
  explicit GridNormals(size_t count) : even(count, Density::even), dense_in_tails(count, Density::dense_in_tails) {}
  VisibleNormals even, dense_in_tails;
};

uint32_t quantities_of(AlbedoGrid::Kind kind) {
  return kind == AlbedoGrid::Kind::glass ? GlassGrid::count : kind == AlbedoGrid::Kind::sheen ? 1 : 2;
}

/// The index beyond the interface on the side where a quantity is seen from.
double index_of(const AlbedoGrid& grid, uint32_t quantity) {
  if (grid.kind == AlbedoGrid::Kind::ggx || grid.kind == AlbedoGrid::Kind::sheen) return 1;
  return grid.kind == AlbedoGrid::Kind::glass && quantity >= GlassGrid::from_within ? 1 / grid.ior : grid.ior;
}

/// The azimuth of a node, by the convention of grid_direction.
Vec2d azimuth_of_node(uint32_t node, uint32_t azimuths) {
  if (azimuths == 1) return {1, 0};
  const double t = 0.5 * (1 - std::cos(pi<double> * node / (azimuths - 1)));
  const double length = std::sqrt(t * t + (1 - t) * (1 - t));
  return {t / length, (1 - t) / length};
}

/// Adds base and edge of GGX with Schlick's Fresnel term. The loops have no branches, so that compilers vectorize over
/// normals.
void add_ggx(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, Quantities& q) {
  const UnshadowedFraction unshadowed(o, alpha);
  const double u2 = sqr(alpha.x), v2 = sqr(alpha.y);
  normals.for_batches(o, alpha, [&](const VisibleNormals::Batch& m) {
    double all[VisibleNormals::Batch::max_count], edges[VisibleNormals::Batch::max_count];
    for (size_t k = 0; k < m.count; ++k) {
      const double cosine = o.x * m.x[k] + o.y * m.y[k] + o.z * m.z[k];
      const double x = 2 * cosine * m.x[k] - o.x, y = 2 * cosine * m.y[k] - o.y, z = 2 * cosine * m.z[k] - o.z;
      const double above = z > 0 ? z : 0.0, fraction = unshadowed.by_squares(u2 * x * x + v2 * y * y, above);
      const double rest = 1 - cosine, rest2 = rest * rest;
      all[k] = cosine > 0 ? m.weight[k] * fraction : 0.0;
      edges[k] = all[k] * (rest2 * rest2 * rest);
    }
    for (size_t k = 0; k < m.count; ++k) q[GgxGrid::base] += all[k] - edges[k], q[GgxGrid::edge] += edges[k];
  });
}

/// Quantities of glass on one side; `eta` is the index of the other side relative to that of `o`.
void add_glass(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, double eta, double* q) {
  const double g1 = ggx_g1(o, alpha);
  const auto kept = [&](const Vec3d& i) { return std::min(1.0, ggx_g1(i, alpha) / g1); };
  normals.for_each(o, alpha, [&](const Vec3d& m, double weight) {
    const double cosine = dot(o, m);
    if (!(cosine > 0)) return;
    double cos_t;
    const double fresnel = fresnel_dielectric(cosine, eta, cos_t);
    const Vec3d r = m * (2 * cosine) - o, t = m * (cosine / eta - cos_t) - o * (1 / eta);
    const double reflected = r.z > 0 ? kept(r) : 0.0, transmitted = fresnel < 1 && t.z < 0 ? kept(t) : 0.0;
    q[GlassGrid::missing] += weight * (fresnel * (1 - reflected) + (1 - fresnel) * (1 - transmitted));
    if (fresnel >= 1) return;
    q[GlassGrid::by_constant] += weight * (reflected - transmitted);
    q[GlassGrid::by_fresnel] += weight * fresnel * (reflected - transmitted);
  });
}

/// Integrates the row of missing fractions over the squared cosine, as GlassGrid says.
void accumulate(const double* missing, double ior, double* cumulative) {
  cumulative[0] = 0;
  for (uint32_t i = 1; i < grid_cosines; ++i) {
    const double width =
        squared_cosine_of_node(i, ior, grid_cosines) - squared_cosine_of_node(i - 1, ior, grid_cosines);
    cumulative[i] = cumulative[i - 1] + 0.5 * (missing[i - 1] + missing[i]) * width;
  }
}

void add_coat(const GridNormals& normals, const AlbedoGrid& grid, const Vec3d& o, const Vec2d& alpha, Quantities& q) {
  q[CoatGrid::interface] = reflected_fraction(normals.dense_in_tails, o, alpha, [&](double cosine, double) {
    double cos_t;
    return fresnel_dielectric(cosine, grid.ior, cos_t);
  });
  if (!grid.conserves) {
    q[CoatGrid::transmission] = transmitted_fraction(normals.even, o, alpha, grid.ior, grid.thickness);
    return;
  }
  q[CoatGrid::transmission] = (1 - q[CoatGrid::interface]) * std::exp(-grid.thickness / cosine_in_coat(o.z, grid.ior));
}

/// Directions of the hemisphere, dense along the horizon, and their solid angles.
class SheenDirections {
 public:
  SheenDirections() {
    constexpr double golden = 0.61803398874989485;
    for (size_t k = 0; k < count; ++k) {
      const double rest = 1 - (static_cast<double>(k) + 0.5) / count, angle = (1 - rest * rest) * pi<double> / 2;
      const double turns = static_cast<double>(k) * golden, turn = 2 * pi<double> * (turns - std::floor(turns));
      directions_[k] = {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
      weights_[k] = std::sin(angle) * rest * 2 * pi<double> * pi<double> / count;
    }
  }

  /// Albedo of sheen of colour 1.
  double albedo(const Vec3d& o, double alpha) const {
    const double roughness = std::max(std::sqrt(alpha), 0.07);
    double sum = 0;
    for (size_t k = 0; k < count; ++k) sum += evaluate_sheen(roughness, o, directions_[k]) * weights_[k];
    return sum;
  }

 private:
  static constexpr size_t count = 1024;
  std::array<Vec3d, count> directions_;
  std::array<double, count> weights_;
};

/// Computes together the quantities of a direction whose nodes have the same cosines.
void add_side(const GridNormals& normals, const AlbedoGrid& grid, uint32_t first, const Vec3d& o, const Vec2d& alpha,
              Quantities& q) {
  switch (grid.kind) {
    case AlbedoGrid::Kind::ggx:
      return add_ggx(normals.dense_in_tails, o, alpha, q);
    case AlbedoGrid::Kind::coat:
      return add_coat(normals, grid, o, alpha, q);
    case AlbedoGrid::Kind::sheen: {
      static const SheenDirections sheen;
      q[0] = sheen.albedo(o, alpha.x);
      return;
    }
    case AlbedoGrid::Kind::glass:
      return add_glass(normals.dense_in_tails, o, alpha, index_of(grid, first), q.data() + first);
  }
}

/// Mean of a quantity over all directions, from its rows.
double mean_of(const double* rows, uint32_t azimuths, double ior) {
  if (azimuths == 1) return mean_of_row(rows, ior, grid_cosines);
  const AlbedoGridPlace<double> place{rows, 1, azimuths, 0, 0, 0, 0};
  constexpr int turns = 16;
  double sum = 0;
  for (int t = 0; t < turns; ++t) {
    const double turn = (t + 0.5) / turns * pi<double> / 2, x = std::cos(turn), y = std::sin(turn);
    sum += mean_over_cosines(ior, [&](double cosine) {
      const double sine = safe_sqrt(1 - cosine * cosine);
      const Vec3d o{sine * x, sine * y, cosine};
      return grid_albedo(place, 0, grid_direction(place, o, ior));
    });
  }
  return sum / turns;
}

/// Mean over the azimuths of the last value of each row.
double mean_of_last(const double* rows, uint32_t azimuths) {
  if (azimuths == 1) return rows[grid_cosines - 1];
  const AlbedoGridPlace<double> place{rows, 1, azimuths, 0, 0, 0, 0};
  constexpr int turns = 256;
  double sum = 0;
  for (int t = 0; t < turns; ++t) {
    const double turn = (t + 0.5) / turns * pi<double> / 2;
    GridDirection<double> d{grid_cosines - 2, 0, 1, 0};
    locate_azimuth(place, std::cos(turn), std::sin(turn), d);
    sum += grid_albedo(place, 0, d);
  }
  return sum / turns;
}

/// Computes the rows of a block; of equal alphas, one azimuth is computed.
void fill_rows(const GridNormals& normals, const AlbedoGrid& grid, const AlbedoGridRecord& record, const Vec2d& alpha,
               double* block) {
  const uint32_t sides = grid.kind == AlbedoGrid::Kind::glass ? 2 : 1, each = record.quantities / sides;
  const uint32_t azimuths = alpha.x == alpha.y ? 1 : record.azimuths;
  for (uint32_t side = 0; side < sides; ++side)
    for (uint32_t a = 0; a < azimuths; ++a)
      for (uint32_t i = 0; i < grid_cosines; ++i) {
        const uint32_t first = side * each;
        const double cosine = cosine_at(i, index_of(grid, first), grid_cosines), sine = safe_sqrt(1 - cosine * cosine);
        const Vec2d azimuth = azimuth_of_node(a, record.azimuths);
        Quantities q{};
        add_side(normals, grid, first, Vec3d{sine * azimuth.x, sine * azimuth.y, cosine}, alpha, q);
        for (uint32_t k = first; k < first + each; ++k)
          for (uint32_t same = a; same < record.azimuths; same += azimuths)
            block[(k * record.azimuths + same) * grid_cosines + i] = q[k];
      }
}

void fill_block(const GridNormals& normals, const AlbedoGrid& grid, const AlbedoGridRecord& record, const Vec2d& alpha,
                double* block) {
  const uint32_t azimuths = alpha.x == alpha.y ? 1 : record.azimuths;
  const auto row = [&](uint32_t k, uint32_t azimuth) { return block + (k * record.azimuths + azimuth) * grid_cosines; };
  double* means = block + record.quantities * record.azimuths * grid_cosines;
  fill_rows(normals, grid, record, alpha, block);
  if (grid.kind == AlbedoGrid::Kind::sheen) return;  // its mean is unused
  if (grid.kind != AlbedoGrid::Kind::glass) {
    for (uint32_t k = 0; k < record.quantities; ++k) means[k] = mean_of(row(k, 0), azimuths, index_of(grid, k));
    return;
  }
  for (const uint32_t side : {0u, GlassGrid::from_within}) {
    for (uint32_t a = 0; a < record.azimuths; ++a)
      accumulate(row(side + GlassGrid::missing, a), index_of(grid, side), row(side + GlassGrid::cumulative, a));
    means[side + GlassGrid::cumulative] = mean_of_last(row(side + GlassGrid::cumulative, 0), azimuths);
  }
}

/// Makes the block of a pair of alphas from that of the exchanged pair.
void mirror_block(const AlbedoGridRecord& record, const double* from, double* to) {
  const uint32_t rows = record.quantities * record.azimuths;
  for (uint32_t row = 0; row < rows; ++row) {
    const uint32_t k = row / record.azimuths, a = row % record.azimuths;
    std::copy_n(from + row * grid_cosines, grid_cosines,
                to + (k * record.azimuths + record.azimuths - 1 - a) * grid_cosines);
  }
  std::copy_n(from + rows * grid_cosines, record.quantities, to + rows * grid_cosines);
}

double alpha_of_node(const std::optional<double>& constant, uint32_t node, uint32_t alphas) {
  return constant ? std::clamp(*constant, min_layered_alpha<double>, 1.0) : alpha_at(node, alphas);
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

/// Number of normals per direction, for errors of at most a thousandth for the grid of one material, and of a few
/// thousandths if alphas are interpolated too. Glass from inside needs more, since total reflection begins abruptly.
size_t normals_of(const AlbedoGrid& grid, const AlbedoGridRecord& record) {
  const bool is_constant = record.alphas_u * record.alphas_v == 1;
  const bool is_isotropic = record.azimuths == 1;
  if (grid.kind == AlbedoGrid::Kind::glass)
    return is_constant ? (is_isotropic ? 1597 : 610) : (is_isotropic ? 377 : 233);
  return is_constant ? 610 : is_isotropic ? 377 : 256;
}

std::vector<double> computed(const AlbedoGrid& grid) {
  const AlbedoGridRecord record = record_of(grid);
  const uint32_t size = grid_block_size(record.quantities, record.azimuths), blocks = record.alphas_u * record.alphas_v;
  const GridNormals normals(normals_of(grid, record));
  std::vector<double> values(static_cast<size_t>(size) * blocks);
  const auto block = [&](uint32_t u, uint32_t v) {
    return values.data() + static_cast<size_t>(size) * (u * record.alphas_v + v);
  };
  const auto alpha_u = blocks == 1 ? grid.alpha_u : std::nullopt, alpha_v = blocks == 1 ? grid.alpha_v : std::nullopt;
#pragma omp parallel for schedule(dynamic)
  for (uint32_t n = 0; n < blocks; ++n) {
    const uint32_t u = n / record.alphas_v, v = n % record.alphas_v;
    if (v > u) continue;
    const double x = alpha_of_node(alpha_u, u, record.alphas_u);
    const double y = grid.is_anisotropic ? alpha_of_node(alpha_v, v, record.alphas_v) : x;
    fill_block(normals, grid, record, {x, y}, block(u, v));
  }
  for (uint32_t u = 0; u < record.alphas_u; ++u)
    for (uint32_t v = u + 1; v < record.alphas_v; ++v) mirror_block(record, block(v, u), block(u, v));
  return values;
}

}  // namespace

Table values_of(const AlbedoGrid& grid) {
  static TableCache<AlbedoGrid> cache;
  return cache.get(grid, [&] { return computed(grid); });
}

}  // namespace alhazen::impl
