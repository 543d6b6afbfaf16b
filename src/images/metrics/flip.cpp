#include "images/metrics/flip.h"

#include <cmath>
#include <numbers>

#include "core/math/vec.h"

namespace alhazen::impl {

namespace {

// Names and values of the constants are those of the paper: section 4.1 for the colours, 4.2 for the features, 4.3 for
// their combination.
constexpr double pi = std::numbers::pi;
constexpr double pixels_per_degree = 0.7 * (3840 / 0.7) * (pi / 180);
constexpr double q_c = 0.7, p_c = 0.4, p_t = 0.95;
constexpr double q_f = 0.5, w = 0.082;

// Colour spaces. X, Y, Z are relative to the white of the display, so that white is (1, 1, 1).

/// Rows: X, Y, Z of the linear sRGB primaries (IEC 61966-2-1) over those of their white, D65.
Vec3d relative_xyz(const Vec3d& rgb) {
  return {dot(rgb, {0.4338953888, 0.3762423726, 0.1898622385}), dot(rgb, {0.2126368217, 0.7151829818, 0.0721801965}),
          dot(rgb, {0.0177524232, 0.1094656287, 0.8727819482})};
}

/// The inverse of `relative_xyz`.
Vec3d linear_rgb(const Vec3d& xyz) {
  return {dot(xyz, {3.0803419883, -1.5373989695, -0.5429430188}), dot(xyz, {-0.9211783962, 1.8759299837, 0.0452484125}),
          dot(xyz, {0.0528812929, -0.2040112061, 1.1511299132})};
}

/// The linearized CIELAB in which contrast sensitivity is measured: Y, Cx (red to green), Cz (yellow to blue).
Vec3d ycxcz(const Vec3d& xyz) { return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)}; }

Vec3d xyz_of_ycxcz(const Vec3d& c) {
  const double y = (c.x + 16) / 116;
  return {y + c.y / 500, y, y - c.z / 200};
}

double cielab_curve(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/// CIELAB with chroma scaled by lightness, for the Hunt effect: dark colours look less colourful.
Vec3d hunt_adjusted_lab(const Vec3d& rgb) {
  const Vec3d xyz = relative_xyz(rgb);
  const Vec3d f{cielab_curve(xyz.x), cielab_curve(xyz.y), cielab_curve(xyz.z)};
  const double lightness = 116 * f.y - 16;
  return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

/// Abasi et al. 2020: city-block in lightness, Euclidean in chroma; for large differences.
double hyab_distance(const Vec3d& a, const Vec3d& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// The colour pipeline.

/// A Gaussian of the contrast sensitivity functions, a sqrt(pi / b) exp(-pi^2 x^2 / b) with x in degrees.
struct SensitivityGaussian {
  double a, b;
};

constexpr SensitivityGaussian achromatic{1, 0.0047}, red_green{1, 0.0053}, blue_yellow_1{34.1, 0.04},
    blue_yellow_2{13.5, 0.025};

/// Three standard deviations of the widest of them.
int sensitivity_radius() {
  return static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow_1.b / (2 * pi * pi)) * pixels_per_degree));
}

std::vector<float> gaussian_kernel(const SensitivityGaussian& gaussian, double& sum) {
  const auto value = [&](double x) {
    const double degrees = x / pixels_per_degree;
    return std::exp(-pi * pi * degrees * degrees / gaussian.b);
  };
  const int radius = sensitivity_radius();
  sum = 0;
  for (const double v : sample_kernel<double>(radius, value)) sum += v;
  return sample_kernel<float>(radius, [&](double x) { return value(x) / sum; });
}

Plane<float> blurred(const Plane<float>& plane, const SensitivityGaussian& gaussian) {
  double sum = 0;
  const std::vector<float> kernel = gaussian_kernel(gaussian, sum);
  return convolve(plane, kernel, kernel);
}

/// The blue-yellow filter is the sum of two Gaussians, which is not separable: two blurs, weighted by the volumes under
/// the Gaussians.
Plane<float> blurred_blue_yellow(const Plane<float>& plane) {
  double sum_1 = 0, sum_2 = 0;
  const std::vector<float> kernel_1 = gaussian_kernel(blue_yellow_1, sum_1);
  const std::vector<float> kernel_2 = gaussian_kernel(blue_yellow_2, sum_2);
  const double volume_1 = blue_yellow_1.a * std::sqrt(pi / blue_yellow_1.b) * sum_1 * sum_1;
  const double volume_2 = blue_yellow_2.a * std::sqrt(pi / blue_yellow_2.b) * sum_2 * sum_2;
  const float weight_1 = static_cast<float>(volume_1 / (volume_1 + volume_2));
  Plane<float> result = convolve(plane, kernel_1, kernel_1);
  const Plane<float> second = convolve(plane, kernel_2, kernel_2);
  for (size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = weight_1 * result.values[i] + (1 - weight_1) * second.values[i];
  return result;
}

Vec3d colour_at(const ColourPlanes& planes, size_t i) {
  return convert<double>(Vec3f{planes[0].values[i], planes[1].values[i], planes[2].values[i]});
}

void set_colour(ColourPlanes& planes, size_t i, const Vec3d& colour) {
  for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)].values[i] = static_cast<float>(colour[c]);
}

/// The part of an image that the eye resolves, in the colour space in which differences are measured.
ColourPlanes perceived_colours(const ColourPlanes& rgb) {
  ColourPlanes planes = rgb;
  const size_t count = rgb[0].values.size();
  for (size_t i = 0; i < count; ++i) set_colour(planes, i, ycxcz(relative_xyz(colour_at(rgb, i))));
  planes = {blurred(planes[0], achromatic), blurred(planes[1], red_green), blurred_blue_yellow(planes[2])};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d filtered = linear_rgb(xyz_of_ycxcz(colour_at(planes, i)));
    set_colour(planes, i, hunt_adjusted_lab(max(min(filtered, splat(1.0)), splat(0.0))));
  }
  return planes;
}

/// Maps a colour distance to [0, 1]: distances up to p_c times the largest one, that between pure green and pure blue,
/// are mapped to [0, p_t].
class ColourError {
 public:
  double operator()(const Vec3d& a, const Vec3d& b) const {
    const double distance = std::pow(hyab_distance(a, b), q_c), knee = p_c * largest_;
    if (distance < knee) return distance * p_t / knee;
    return p_t + (distance - knee) / (largest_ - knee) * (1 - p_t);
  }

 private:
  double largest_ = std::pow(hyab_distance(hunt_adjusted_lab({0, 1, 0}), hunt_adjusted_lab({0, 0, 1})), q_c);
};

// The feature pipeline.

/// Edges and points of the luminance: magnitudes of the first and second derivatives.
struct Features {
  Plane<float> edges, points;
};

/// The derivative of a Gaussian given by `value`, scaled so that its positive values sum to 1 and its negative ones to
/// -1.
std::vector<float> derivative_kernel(int radius, const std::function<double(double)>& value) {
  double positive = 0, negative = 0;
  for (const double v : sample_kernel<double>(radius, value)) (v > 0 ? positive : negative) += std::abs(v);
  return sample_kernel<float>(radius, [&](double x) { return value(x) / (value(x) > 0 ? positive : negative); });
}

Plane<float> magnitude(const Plane<float>& in, const std::vector<float>& derivative, const std::vector<float>& blur) {
  Plane<float> result = convolve(in, derivative, blur);
  const Plane<float> vertical = convolve(in, blur, derivative);
  for (size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = std::sqrt(result.values[i] * result.values[i] + vertical.values[i] * vertical.values[i]);
  return result;
}

Features detect_features(const ColourPlanes& rgb) {
  constexpr double sigma = 0.5 * w * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  double sum = 0;
  for (const double v : sample_kernel<double>(radius, gaussian)) sum += v;
  const auto blur = sample_kernel<float>(radius, [&](double x) { return gaussian(x) / sum; });
  const auto first = derivative_kernel(radius, [&](double x) { return -x * gaussian(x); });
  const auto second = derivative_kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); });

  Plane<float> luminance(rgb[0].width, rgb[0].height);
  for (size_t i = 0; i < luminance.values.size(); ++i)
    luminance.values[i] = static_cast<float>(relative_xyz(colour_at(rgb, i)).y);
  return {magnitude(luminance, first, blur), magnitude(luminance, second, blur)};
}

}  // namespace

Plane<float> flip_map(const ColourPlanes& test, const ColourPlanes& reference) {
  Plane<float> map(test[0].width, test[0].height);
  {
    const ColourPlanes a = perceived_colours(test), b = perceived_colours(reference);
    const ColourError colour_error;
    for (size_t i = 0; i < map.values.size(); ++i)
      map.values[i] = static_cast<float>(colour_error(colour_at(a, i), colour_at(b, i)));
  }
  const Features a = detect_features(test), b = detect_features(reference);
  for (size_t i = 0; i < map.values.size(); ++i) {
    const float edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const float points = std::abs(a.points.values[i] - b.points.values[i]);
    const double difference = std::min(1.0, static_cast<double>(std::max(edges, points)) / std::numbers::sqrt2);
    const double feature_error = std::pow(difference, q_f);
    map.values[i] = static_cast<float>(std::pow(static_cast<double>(map.values[i]), 1 - feature_error));
  }
  return map;
}

}  // namespace alhazen::impl
