#pragma once

// An environment map: radiance from infinitely far away, given by an image of the whole sphere with bilinear
// interpolation. It is sampled by a distribution that is constant over each texel: first a cell, which is a rectangle
// of texels, then a row of the cell and a texel in the row (Pharr, Jakob, Humphreys 2016, 14.2.4). The density is that
// of the radiance above its mean, since BSDF sampling finds the rest with less variance. Cells are chosen by what they
// send to a surface: there is a distribution over the cells for each group of similar normals. Densities are over solid
// angle.

#include "core/lights/kinds/light_base.h"
#include "core/lights/sphere_mapping.h"
#include "core/sampling/discrete.h"

namespace ALHAZEN_CORE {

template <class Real>
struct EnvironmentSample {
  Vec3<Real> direction{};  ///< unit, in world space
  Vec3<Real> radiance{};
  Real pdf = 0;  ///< 0 if nothing was sampled
};

template <class Real>
ALHAZEN_HD Vec3<Real> environment_texel(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map, int x,
                                        int y) {
  const Texel at = texel_of_sphere(map.mapping, x, y, static_cast<int>(map.width), static_cast<int>(map.height));
  const uint64_t index = static_cast<uint64_t>(at.y) * map.width + static_cast<uint64_t>(at.x);
  const float* t = scene.texel_floats + map.first_texel + 3 * index;
  return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
}

/// Radiance at a point of the image; texel centres are at half integers.
template <class Real>
ALHAZEN_HD Vec3<Real> lookup_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                         const Vec2<Real>& uv) {
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return {};  // the direction is NaN
  const Real x = uv.x * static_cast<Real>(map.width) - Real(0.5), y = uv.y * static_cast<Real>(map.height) - Real(0.5);
  const Real fx = std::floor(x), fy = std::floor(y);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const Vec3<Real> top = lerp(environment_texel(scene, map, ix, iy), environment_texel(scene, map, ix + 1, iy), x - fx);
  const Vec3<Real> bottom =
      lerp(environment_texel(scene, map, ix, iy + 1), environment_texel(scene, map, ix + 1, iy + 1), x - fx);
  return lerp(top, bottom, y - fy) * map.scale;
}

/// Radiance that arrives from unit `direction`, which points out of the scene.
template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                           const Vec3<Real>& direction) {
  return lookup_environment(scene, map, square_of_direction(map.mapping, map.axes.to_local(direction)));
}

/// Normals are in groups by their place on an octahedron that is unfolded into a square of this many cells a side; a
/// last group is that of surfaces which light may reach from anywhere.
inline constexpr uint32_t normal_groups_per_side = 16;
inline constexpr uint32_t any_normal_group = normal_groups_per_side * normal_groups_per_side;
inline constexpr uint32_t normal_groups = any_normal_group + 1;

/// The group of a normal that is local to a map; zero means any.
template <class Real>
ALHAZEN_HD uint32_t normal_group(const Vec3<Real>& n) {
  const Real sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) return any_normal_group;
  const Real x = n.x / sum, y = n.y / sum;
  const Real u = n.z < 0 ? std::copysign(1 - std::abs(y), x) : x, v = n.z < 0 ? std::copysign(1 - std::abs(x), y) : y;
  const auto place = [](Real t) {
    const int i = static_cast<int>((t + 1) * (Real(0.5) * normal_groups_per_side));
    return static_cast<uint32_t>(min(max(i, 0), static_cast<int>(normal_groups_per_side) - 1));
  };
  return place(v) * normal_groups_per_side + place(u);
}

/// A unit normal in the middle of a group.
template <class Real>
ALHAZEN_HD Vec3<Real> normal_of_group(uint32_t group) {
  const auto middle = [](uint32_t i) { return static_cast<Real>(2 * i + 1) / normal_groups_per_side - 1; };
  const Real u = middle(group % normal_groups_per_side), v = middle(group / normal_groups_per_side);
  const Real z = 1 - std::abs(u) - std::abs(v);
  if (z >= 0) return normalize(Vec3<Real>{u, v, z});
  return normalize(Vec3<Real>{std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), z});
}

/// The sine of the largest angle between a normal and the middle of its group.
inline constexpr double normal_group_radius = 0.2602;

/// A rectangle of texels, and where its distributions begin in SceneView::environment_cdf: of its rows, and of the
/// texels of each row.
struct EnvironmentCell {
  uint32_t x, y, width, height;
  uint64_t first;
};

/// The first texel of cell `i` of `cells` along a side of `size` texels.
ALHAZEN_HD inline uint32_t first_of_cell(uint32_t i, uint32_t size, uint32_t cells) { return i * size / cells; }
/// The cell of a texel.
ALHAZEN_HD inline uint32_t cell_of_texel(uint32_t texel, uint32_t size, uint32_t cells) {
  return ((texel + 1) * cells - 1) / size;
}

/// Number of values in the distribution over the cells for one group of normals: cell_rows + 1 over the rows of cells,
/// then cell_columns + 1 for each row.
template <class Real>
ALHAZEN_HD uint32_t cell_distribution_size(const EnvironmentRecord<Real>& map) {
  return map.cell_rows + 1 + map.cell_rows * (map.cell_columns + 1);
}

template <class Real>
ALHAZEN_HD EnvironmentCell environment_cell(const EnvironmentRecord<Real>& map, uint32_t column, uint32_t row) {
  EnvironmentCell c;
  c.x = first_of_cell(column, map.width, map.cell_columns);
  c.y = first_of_cell(row, map.height, map.cell_rows);
  c.width = first_of_cell(column + 1, map.width, map.cell_columns) - c.x;
  c.height = first_of_cell(row + 1, map.height, map.cell_rows) - c.y;
  // A cell takes height + 1 values, and width + 1 for each of its rows.
  const uint64_t of_groups = uint64_t{normal_groups} * cell_distribution_size(map);
  const uint64_t of_rows = uint64_t{row} * map.cell_columns + c.y * (uint64_t{map.width} + 2 * map.cell_columns);
  c.first = map.first_cdf + of_groups + of_rows + column + c.height * (uint64_t{c.x} + 2 * column);
  return c;
}

/// The distribution over the rows of cells for a group of normals; after its cell_rows + 1 values come those over the
/// cells of each row.
template <class Real>
ALHAZEN_HD const Real* cell_distribution(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                         uint32_t group) {
  return scene.environment_cdf + map.first_cdf + uint64_t{group} * cell_distribution_size(map);
}

/// Density over the unit square within texel (column, row), for surfaces whose normals are in `group`.
template <class Real>
ALHAZEN_HD Real environment_square_pdf(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map, uint32_t group,
                                       uint32_t row, uint32_t column) {
  const uint32_t cell_column = cell_of_texel(column, map.width, map.cell_columns);
  const uint32_t cell_row = cell_of_texel(row, map.height, map.cell_rows);
  const EnvironmentCell cell = environment_cell(map, cell_column, cell_row);
  const Real* all_rows = cell_distribution(scene, map, group);
  const Real* cell_rows = all_rows + cell_row;
  const Real* cells = all_rows + (map.cell_rows + 1) + cell_row * (map.cell_columns + 1) + cell_column;
  const Real* rows = scene.environment_cdf + cell.first + (row - cell.y);
  const Real* columns =
      scene.environment_cdf + cell.first + (cell.height + 1) + (row - cell.y) * (cell.width + 1) + (column - cell.x);
  return (cell_rows[1] - cell_rows[0]) * (cells[1] - cells[0]) * ((rows[1] - rows[0]) * static_cast<Real>(map.height)) *
         ((columns[1] - columns[0]) * static_cast<Real>(map.width));
}

/// Samples a direction from which light arrives at a surface: `normal` is on the side that it must arrive from; zero
/// means any.
template <class Real>
ALHAZEN_HD EnvironmentSample<Real> sample_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                                      const Vec3<Real>& normal, const Vec2<Real>& u) {
  EnvironmentSample<Real> s;
  const Real* cell_rows = cell_distribution(scene, map, normal_group(map.axes.to_local(normal)));
  if (!(cell_rows[map.cell_rows] > 0)) return s;
  const uint32_t cell_row = sample_cdf(cell_rows, map.cell_rows, u.y);
  const Real* cells = cell_rows + (map.cell_rows + 1) + cell_row * (map.cell_columns + 1);
  const uint32_t cell_column = sample_cdf(cells, map.cell_columns, u.x);
  const EnvironmentCell cell = environment_cell(map, cell_column, cell_row);
  const Real u_row = position_within(cell_rows, cell_row, u.y), u_column = position_within(cells, cell_column, u.x);
  const Real* rows = scene.environment_cdf + cell.first;
  const uint32_t row = sample_cdf(rows, cell.height, u_row);
  const Real* columns = rows + (cell.height + 1) + row * (cell.width + 1);
  const uint32_t column = sample_cdf(columns, cell.width, u_column);
  const Vec2<Real> uv{
      (static_cast<Real>(cell.x + column) + position_within(columns, column, u_column)) / static_cast<Real>(map.width),
      (static_cast<Real>(cell.y + row) + position_within(rows, row, u_row)) / static_cast<Real>(map.height)};
  const Vec3<Real> direction = direction_of_square(map.mapping, uv);
  const Real solid_angle = solid_angle_of_square(map.mapping, direction);
  if (!(solid_angle > 0)) return s;
  s.direction = map.axes.to_world(direction);
  s.radiance = lookup_environment(scene, map, uv);
  s.pdf = (cell_rows[cell_row + 1] - cell_rows[cell_row]) * (cells[cell_column + 1] - cells[cell_column]) *
          ((rows[row + 1] - rows[row]) * static_cast<Real>(map.height)) *
          ((columns[column + 1] - columns[column]) * static_cast<Real>(map.width)) / solid_angle;
  return s;
}

/// Density with which `sample_environment` returns the direction that is `local` to the map and has coordinates `uv`.
template <class Real>
ALHAZEN_HD Real pdf_environment_at(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                   const Vec3<Real>& normal, const Vec3<Real>& local, const Vec2<Real>& uv) {
  const Real solid_angle = solid_angle_of_square(map.mapping, local);
  if (!(solid_angle > 0)) return 0;
  if (!(uv.x >= 0 && uv.y >= 0)) return 0;
  const uint32_t column = static_cast<uint32_t>(uv.x * static_cast<Real>(map.width));
  const uint32_t row = static_cast<uint32_t>(uv.y * static_cast<Real>(map.height));
  return environment_square_pdf(scene, map, normal_group(map.axes.to_local(normal)), min(row, map.height - 1),
                                min(column, map.width - 1)) /
         solid_angle;
}

/// Density with which `sample_environment` returns unit `direction` for `normal`.
template <class Real>
ALHAZEN_HD Real pdf_environment(const SceneView<Real>& scene, const EnvironmentRecord<Real>& map,
                                const Vec3<Real>& normal, const Vec3<Real>& direction) {
  const Vec3<Real> local = map.axes.to_local(direction);
  return pdf_environment_at(scene, map, normal, local, square_of_direction(map.mapping, local));
}

/// The map's radiance for a ray that escapes along unit `direction` from a surface with `normal`, and its density if
/// `wants_pdf`. Both use the same lookup, which is done once.
template <class Real>
ALHAZEN_HD EnvironmentSample<Real> evaluate_environment_and_pdf(const SceneView<Real>& scene,
                                                                const EnvironmentRecord<Real>& map,
                                                                const Vec3<Real>& normal, const Vec3<Real>& direction,
                                                                bool wants_pdf) {
  const Vec3<Real> local = map.axes.to_local(direction);
  const Vec2<Real> uv = square_of_direction(map.mapping, local);
  EnvironmentSample<Real> s{direction, lookup_environment(scene, map, uv), 0};
  if (wants_pdf && !is_zero(s.radiance)) s.pdf = pdf_environment_at(scene, map, normal, local, uv);
  return s;
}

}  // namespace ALHAZEN_CORE
