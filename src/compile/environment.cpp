#include "compile/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/lights/environment.h"

namespace alhazen::impl {

namespace {

/// Fraction of each distribution that is distributed evenly over all that is above 0. Without it the probabilities of
/// what is beside a sun would be lost to rounding.
constexpr double uniform_fraction = 1.0 / 256;

SphereMapping mapping_of(const Light& light, const ImageTexels& map) {
  const bool is_octahedral = map.width == map.height;
  if (map.width < 1 || !(is_octahedral || map.width == 2 * map.height) ||
      map.floats.size() != 3 * static_cast<size_t>(map.width) * static_cast<size_t>(map.height))
    throw InputError(light.where, "the environment map is neither square nor twice as wide as high");
  return is_octahedral ? SphereMapping::octahedral : SphereMapping::equirectangular;
}

/// Brightness of a texel: its luminance, but above zero unless the texel is black.
double worth(const float* texel) {
  const Vec3d colour{static_cast<double>(texel[0]), static_cast<double>(texel[1]), static_cast<double>(texel[2])};
  return std::max(luminance(colour), 1e-3 * max_component(colour));
}

/// Means, over the square of each texel, of the bilinearly interpolated brightness. Neighbours have the weights 1/8,
/// 6/8, 1/8 along each axis.
std::vector<double> texel_means(const ImageTexels& map, SphereMapping mapping) {
  const int width = map.width, height = map.height;
  const auto index = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  std::vector<double> worths(map.floats.size() / 3), means(worths.size());
  for (size_t i = 0; i < worths.size(); ++i) worths[i] = worth(&map.floats[3 * i]);
  constexpr double weights[] = {0.125, 0.75, 0.125};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double mean = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Texel at = texel_of_sphere(mapping, x + dx, y + dy, width, height);
          mean += weights[dx + 1] * weights[dy + 1] * worths[index(at.x, at.y)];
        }
      means[index(x, y)] = mean;
    }
  return means;
}

/// Solid angle of a texel in row `y`, steradians.
double texel_solid_angle(const ImageTexels& map, SphereMapping mapping, int y) {
  if (mapping == SphereMapping::octahedral) return 4 * std::numbers::pi / map.width / map.height;
  const auto cosine = [&](int edge) { return std::cos(std::numbers::pi * edge / map.height); };
  return 2 * std::numbers::pi / map.width * (cosine(y) - cosine(y + 1));
}

/// Appends count + 1 cumulative probabilities of the weights; those above 0 receive `uniform_fraction` in equal parts.
template <class Real>
void append_cdf(const double* weights, size_t count, std::vector<Real>& out) {
  const double sum = std::accumulate(weights, weights + count, 0.0);
  const auto positive = static_cast<double>(std::count_if(weights, weights + count, [](double w) { return w > 0; }));
  double below = 0;
  out.push_back(Real(0));
  for (size_t i = 0; i < count; ++i) {
    if (weights[i] > 0) below += (1 - uniform_fraction) * weights[i] / sum + uniform_fraction / positive;
    out.push_back(static_cast<Real>(std::min(below, 1.0)));
  }
  // Rounding may have left the last value below 1; items of zero weight after it must not be chosen.
  const Real last = out.back();
  for (size_t i = out.size(); i-- > 0 && out[i] == last && positive > 0;) out[i] = Real(1);
}

/// Below this part of all light, what exceeds the mean is rounding, and the map is as good as constant.
constexpr double min_excess = 1e-6;

/// Number of cells along each side of a map that has as many texels.
constexpr uint32_t cells_per_side = 16;

/// The light above the mean from a part of a cell: its direction, the sine of the angle about it that bounds the part,
/// and the irradiance at a surface that faces it.
struct CellPart {
  Vec3d direction;
  double radius;
  double irradiance;
};

/// What a part sends to the surfaces of a group: the irradiance times the mean of the positive cosine, as if the cosine
/// were uniform within what the sizes of the part and the group allow.
double sent_to(const Vec3d& normal, const CellPart& part) {
  const double cosine = dot(normal, part.direction), spread = part.radius + normal_group_radius;
  if (cosine > spread) return part.irradiance * cosine;
  return part.irradiance * sqr(std::max(0.0, cosine + spread)) / (4 * spread);
}

/// The brightness of each texel minus the mean over the sphere, where that is positive, times its solid angle.
class ExcessLight {
 public:
  ExcessLight(const ImageTexels& map, SphereMapping mapping, const EnvironmentRecord<double>& cells)
      : mapping_(mapping), cells_(cells), light_(texel_means(map, mapping)) {
    double all = 0;
    for (uint32_t y = 0; y < cells.height; ++y) {
      const double solid_angle = texel_solid_angle(map, mapping, static_cast<int>(y));
      for (uint32_t x = 0; x < cells.width; ++x) all += light_[index(x, y)] * solid_angle;
    }
    double excess = 0;
    for (uint32_t y = 0; y < cells.height; ++y) {
      const double solid_angle = texel_solid_angle(map, mapping, static_cast<int>(y));
      for (uint32_t x = 0; x < cells.width; ++x) {
        double& light = light_[index(x, y)];
        light = std::max(light - all / (4 * std::numbers::pi), 0.0) * solid_angle;
        excess += light;
      }
    }
    part_of_all_ = excess / all;
  }

  double part_of_all() const { return part_of_all_; }
  const double* row(uint32_t x, uint32_t y) const { return &light_[index(x, y)]; }

  double of_row(const EnvironmentCell& cell, uint32_t y) const {
    return std::accumulate(row(cell.x, y), row(cell.x, y) + cell.width, 0.0);
  }

  /// The light from parts of a cell, at most 8 by 8.
  std::vector<CellPart> parts(const EnvironmentCell& cell) const {
    const uint32_t columns = std::min(cell.width, 8u), rows = std::min(cell.height, 8u);
    std::vector<CellPart> parts;
    for (uint32_t i = 0; i < rows; ++i)
      for (uint32_t k = 0; k < columns; ++k) {
        const uint32_t x0 = cell.x + first_of_cell(k, cell.width, columns);
        const uint32_t x1 = cell.x + first_of_cell(k + 1, cell.width, columns);
        const uint32_t y0 = cell.y + first_of_cell(i, cell.height, rows);
        const uint32_t y1 = cell.y + first_of_cell(i + 1, cell.height, rows);
        CellPart part{};
        for (uint32_t y = y0; y < y1; ++y)
          for (uint32_t x = x0; x < x1; ++x) {
            const double light = light_[index(x, y)];
            if (light == 0) continue;
            part.irradiance += light;
            part.direction += direction(x + 0.5, y + 0.5) * light;
          }
        if (part.irradiance == 0 || is_zero(part.direction)) continue;
        part.direction = normalize(part.direction);
        for (const uint32_t x : {x0, x1})
          for (const uint32_t y : {y0, y1})
            part.radius = std::max(part.radius, length(cross(part.direction, direction(x, y))));
        parts.push_back(part);
      }
    return parts;
  }

 private:
  size_t index(uint32_t x, uint32_t y) const { return static_cast<size_t>(y) * cells_.width + x; }
  Vec3d direction(double x, double y) const {
    return direction_of_square(mapping_, Vec2<double>{x / cells_.width, y / cells_.height});
  }

  SphereMapping mapping_;
  EnvironmentRecord<double> cells_;  ///< only its sizes
  std::vector<double> light_;
  double part_of_all_ = 0;
};

/// Appends the distribution over the cells for one group of normals.
template <class Real>
void append_cell_distribution(const double* weights, const EnvironmentRecord<Real>& map, std::vector<Real>& out) {
  std::vector<double> rows;
  for (uint32_t y = 0; y < map.cell_rows; ++y)
    rows.push_back(std::accumulate(weights + y * map.cell_columns, weights + (y + 1) * map.cell_columns, 0.0));
  append_cdf(rows.data(), rows.size(), out);
  for (uint32_t y = 0; y < map.cell_rows; ++y) append_cdf(weights + y * map.cell_columns, map.cell_columns, out);
}

/// Appends the distributions of the light above the mean: MIS compensation (Karlik, Sik, Vevoda, Skrivan, Krivanek
/// 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", section 5). Returns what
/// part of the integral of the brightness that is; 0 if there is nothing to sample.
template <class Real>
double append_distributions(const ImageTexels& map, const EnvironmentRecord<Real>& record, std::vector<Real>& out) {
  EnvironmentRecord<double> cells{};
  cells.width = record.width, cells.height = record.height;
  cells.cell_columns = record.cell_columns, cells.cell_rows = record.cell_rows;
  const ExcessLight light(map, record.mapping, cells);
  std::vector<EnvironmentCell> all_cells;
  std::vector<double> weights[normal_groups];
  for (uint32_t y = 0; y < record.cell_rows; ++y)
    for (uint32_t x = 0; x < record.cell_columns; ++x) all_cells.push_back(environment_cell(cells, x, y));
  Vec3d normals[any_normal_group];
  for (uint32_t group = 0; group < any_normal_group; ++group) normals[group] = normal_of_group<double>(group);
  for (const EnvironmentCell& cell : all_cells) {
    const std::vector<CellPart> parts = light.parts(cell);
    for (uint32_t group = 0; group < any_normal_group; ++group) {
      double weight = 0;
      for (const CellPart& part : parts) weight += sent_to(normals[group], part);
      weights[group].push_back(weight);
    }
    double weight = 0;
    for (const CellPart& part : parts) weight += part.irradiance;
    weights[any_normal_group].push_back(weight);
  }
  for (const std::vector<double>& of_group : weights) append_cell_distribution(of_group.data(), record, out);
  for (const EnvironmentCell& cell : all_cells) {
    std::vector<double> rows;
    for (uint32_t y = cell.y; y < cell.y + cell.height; ++y) rows.push_back(light.of_row(cell, y));
    append_cdf(rows.data(), rows.size(), out);
    for (uint32_t y = cell.y; y < cell.y + cell.height; ++y) append_cdf(light.row(cell.x, y), cell.width, out);
  }
  return light.part_of_all() > min_excess ? light.part_of_all() : 0;
}

Vec3d mean_radiance(const ImageTexels& map, SphereMapping mapping) {
  Vec3d mean{};
  const float* texel = map.floats.data();
  for (int y = 0; y < map.height; ++y) {
    Vec3d row{};
    for (int x = 0; x < map.width; ++x, texel += 3)
      row += {static_cast<double>(texel[0]), static_cast<double>(texel[1]), static_cast<double>(texel[2])};
    mean += row * (texel_solid_angle(map, mapping, y) / (4 * std::numbers::pi));
  }
  return mean;
}

}  // namespace

namespace {

/// Appends the texels of a map and its distributions.
template <class Real>
typename LightMaps<Real>::Environment add_map(ImageTexels& map, SphereMapping mapping, const Vec3d& mean_radiance,
                                              SceneArrays<Real>& out) {
  EnvironmentRecord<Real> record{};
  record.mapping = mapping;
  record.width = static_cast<uint32_t>(map.width);
  record.height = static_cast<uint32_t>(map.height);
  record.first_cdf = out.environment_cdf.size();
  record.cell_columns = std::min(record.width, cells_per_side);
  record.cell_rows = std::min(record.height, cells_per_side);
  const double excess = append_distributions(map, record, out.environment_cdf);
  record.first_texel = out.texel_floats.size();
  out.texel_floats.insert(out.texel_floats.end(), map.floats.begin(), map.floats.end());
  std::vector<float>().swap(map.floats);
  return {record, mean_radiance, excess};
}

}  // namespace

template <class Real>
double add_environment(const Light& light, Scene& scene, LightMaps<Real>& maps, SceneArrays<Real>& out) {
  if (light.environment >= scene.environments.size()) throw InputError(light.where, "the light names no map");
  ImageTexels& map = scene.environments[light.environment];
  maps.environments.resize(scene.environments.size());
  auto& compiled = maps.environments[light.environment];
  const SphereMapping mapping = compiled ? compiled->record.mapping : mapping_of(light, map);
  const Vec3d mean = compiled ? compiled->mean_radiance : mean_radiance(map, mapping);
  LightRecord<Real> light_record{};
  light_record.kind = LightKind::environment;
  light_record.primitive = static_cast<uint32_t>(out.environments.size());
  light_record.radiance = convert<Real>(mean * light.radiance);
  if (!is_finite(light_record.radiance))
    throw InputError(light.where, "the environment map holds values that are not finite or too large");
  if (is_zero(light_record.radiance)) return 0;
  if (!compiled) compiled = add_map(map, mapping, mean, out);
  EnvironmentRecord<Real> record = compiled->record;
  record.light = static_cast<uint32_t>(out.lights.size());
  record.axes = {convert<Real>(light.axes.tangent), convert<Real>(light.axes.bitangent),
                 convert<Real>(light.axes.normal)};
  record.scale = convert<Real>(light.radiance);
  out.environments.push_back(record);
  out.lights.push_back(light_record);
  return compiled->excess;
}

template double add_environment(const Light&, Scene&, LightMaps<float>&, SceneArrays<float>&);
template double add_environment(const Light&, Scene&, LightMaps<double>&, SceneArrays<double>&);

}  // namespace alhazen::impl
