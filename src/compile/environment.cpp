#include "compile/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace alhazen {

namespace {

/// Fraction of a row's probability, and of the rows', that is distributed evenly over all texels. It keeps the
/// probability of a texel above what float resolves in maps of up to 2^14 texels a side, however bright a sun is in the
/// row.
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

/// Appends the distribution of the brightness minus its mean over the sphere, where that is positive: MIS compensation
/// (Karlik, Sik, Vevoda, Skrivan, Krivanek 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple
/// Importance Sampling", section 5). Returns what part of the integral of the brightness that is; 0 if there is no
/// distribution.
template <class Real>
double append_distribution(const ImageTexels& map, SphereMapping mapping, std::vector<Real>& out) {
  std::vector<double> means = texel_means(map, mapping);
  const size_t width = static_cast<size_t>(map.width), height = static_cast<size_t>(map.height);
  const auto row_integral = [&](size_t y) {
    return texel_solid_angle(map, mapping, static_cast<int>(y)) *
           std::accumulate(&means[y * width], &means[y * width] + width, 0.0);
  };
  double all = 0;
  for (size_t y = 0; y < height; ++y) all += row_integral(y);
  for (double& mean : means) mean = std::max(mean - all / (4 * std::numbers::pi), 0.0);
  std::vector<double> rows;
  for (size_t y = 0; y < height; ++y) rows.push_back(row_integral(y));
  const double excess = std::accumulate(rows.begin(), rows.end(), 0.0) / all;
  out.reserve(out.size() + (height + 1) + height * (width + 1));
  append_cdf(rows.data(), height, out);
  for (size_t y = 0; y < height; ++y) append_cdf(&means[y * width], width, out);
  return excess > min_excess ? excess : 0;
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

template <class Real>
double add_environment(const Light& light, Scene& scene, SceneArrays<Real>& out) {
  if (light.environment >= scene.environments.size()) throw InputError(light.where, "the light names no map");
  ImageTexels& map = scene.environments[light.environment];
  EnvironmentRecord<Real> record{};
  record.mapping = mapping_of(light, map);
  LightRecord<Real> light_record{};
  light_record.kind = LightKind::environment;
  light_record.primitive = static_cast<uint32_t>(out.environments.size());
  light_record.radiance = convert<Real>(mean_radiance(map, record.mapping) * light.radiance);
  if (!is_finite(light_record.radiance))
    throw InputError(light.where, "the environment map holds values that are not finite or too large");
  if (is_zero(light_record.radiance)) return 0;
  record.width = static_cast<uint32_t>(map.width);
  record.height = static_cast<uint32_t>(map.height);
  record.light = static_cast<uint32_t>(out.lights.size());
  record.axes = {convert<Real>(light.axes.tangent), convert<Real>(light.axes.bitangent),
                 convert<Real>(light.axes.normal)};
  record.scale = convert<Real>(light.radiance);
  record.first_cdf = out.environment_cdf.size();
  const double excess = append_distribution(map, record.mapping, out.environment_cdf);
  record.first_texel = out.texel_floats.size();
  out.texel_floats.insert(out.texel_floats.end(), map.floats.begin(), map.floats.end());
  std::vector<float>().swap(map.floats);
  out.environments.push_back(record);
  out.lights.push_back(light_record);
  return excess;
}

template double add_environment(const Light&, Scene&, SceneArrays<float>&);
template double add_environment(const Light&, Scene&, SceneArrays<double>&);

}  // namespace alhazen
