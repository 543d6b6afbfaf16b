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

namespace alhazen {

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

/// Calls visit(direction, fraction reflected, or transmitted if it is below, Fresnel reflectance) for what single
/// scattering sends from `o` in either direction. `eta` is the index of the other side relative to that of `o`.
template <class Visit>
void for_each_glass_facet(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, double eta,
                          const Visit& visit) {
  const UnshadowedFraction unshadowed(o, alpha);
  normals.for_each(o, alpha, [&](const Vec3d& m, double weight) {
    const double cosine = dot(o, m);
    if (!(cosine > 0)) return;
    double cos_t;
    const double fresnel = fresnel_dielectric(cosine, eta, cos_t);
    const Vec3d r = m * (2 * cosine) - o;
    if (r.z > 0) visit(r, weight * unshadowed(r), fresnel);
    if (fresnel >= 1) return;
    const Vec3d t = m * (cosine / eta - cos_t) - o * (1 / eta);
    if (t.z < 0) visit(t, weight * unshadowed(t), fresnel);
  });
}

double single_glass_albedo(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, double eta) {
  double sum = 0;
  for_each_glass_facet(normals, o, alpha, eta, [&](const Vec3d& i, double fraction, double fresnel) {
    sum += fraction * (i.z > 0 ? fresnel : 1 - fresnel);
  });
  return sum;
}

/// The quantities of glass on one side that depend on the albedos of single scattering, which `block` already holds.
/// `o.z` < 0 from within; `place` is that of the block.
void add_glass(const VisibleNormals& normals, const Vec3d& o, const Vec2d& alpha, double ior,
               const AlbedoGridPlace<double>& place, double* q) {
  const bool within = o.z < 0;
  const double side = within ? -1 : 1;
  const GlassAlbedo<double> of_o = glass_albedo(place, ior, o);
  double all = 0;
  for_each_glass_facet(
      normals, o * side, alpha, within ? 1 / ior : ior, [&](const Vec3d& i, double fraction, double fresnel) {
        const double scaled = fraction * single_scattering_scale(of_o, glass_albedo(place, ior, i * side));
        all += scaled * (i.z > 0 ? fresnel : 1 - fresnel);
        if (fresnel >= 1) return;
        const double gain = i.z > 0 ? scaled : -scaled;
        q[GlassGrid::by_constant] += gain;
        q[GlassGrid::by_fresnel] += fresnel * gain;
      });
  q[GlassGrid::missing] = std::max(0.0, 1 - all);
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
      q[first + GlassGrid::single] = single_glass_albedo(normals.dense_in_tails, o, alpha, index_of(grid, first));
      return;
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

/// Calls compute(first quantity, direction, q) for each direction of a side, and stores what it sets of q. Of equal
/// alphas, one azimuth is computed.
template <class Compute>
void fill_rows(const AlbedoGrid& grid, const AlbedoGridRecord& record, const Vec2d& alpha, double* block,
               uint32_t first_of_side, uint32_t count, const Compute& compute) {
  const uint32_t sides = grid.kind == AlbedoGrid::Kind::glass ? 2 : 1, each = record.quantities / sides;
  const uint32_t azimuths = alpha.x == alpha.y ? 1 : record.azimuths;
  for (uint32_t side = 0; side < sides; ++side)
    for (uint32_t a = 0; a < azimuths; ++a)
      for (uint32_t i = 0; i < grid_cosines; ++i) {
        const uint32_t first = side * each;
        const double cosine = cosine_at(i, index_of(grid, first), grid_cosines), sine = safe_sqrt(1 - cosine * cosine);
        const Vec2d azimuth = azimuth_of_node(a, record.azimuths);
        Quantities q{};
        compute(first, Vec3d{sine * azimuth.x, sine * azimuth.y, cosine}, q);
        for (uint32_t k = first + first_of_side; k < first + first_of_side + count; ++k)
          for (uint32_t same = a; same < record.azimuths; same += azimuths)
            block[(k * record.azimuths + same) * grid_cosines + i] = q[k];
      }
}

void fill_block(const GridNormals& normals, const AlbedoGrid& grid, const AlbedoGridRecord& record, const Vec2d& alpha,
                double* block) {
  const bool is_glass = grid.kind == AlbedoGrid::Kind::glass;
  const uint32_t azimuths = alpha.x == alpha.y ? 1 : record.azimuths;
  fill_rows(grid, record, alpha, block, 0, is_glass ? 1 : record.quantities,
            [&](uint32_t first, const Vec3d& o, Quantities& q) { add_side(normals, grid, first, o, alpha, q); });
  if (is_glass) {
    const AlbedoGridPlace<double> place{block, record.quantities, record.azimuths, 0, 0, 0, 0};
    fill_rows(grid, record, alpha, block, 1, GlassGrid::from_within - 1,
              [&](uint32_t first, const Vec3d& o, Quantities& q) {
                const Vec3d w{o.x, o.y, first == GlassGrid::from_within ? -o.z : o.z};
                add_glass(normals.dense_in_tails, w, alpha, grid.ior, place, q.data() + first);
              });
  }
  if (grid.kind == AlbedoGrid::Kind::sheen) return;  // its mean is unused
  for (uint32_t k = 0; k < record.quantities; ++k) {
    if (is_glass && k % GlassGrid::from_within != GlassGrid::missing) continue;  // these means are unused too
    block[record.quantities * record.azimuths * grid_cosines + k] =
        mean_of(block + k * record.azimuths * grid_cosines, azimuths, index_of(grid, k));
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

}  // namespace alhazen
