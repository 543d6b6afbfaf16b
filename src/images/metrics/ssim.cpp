#include "images/metrics/ssim.h"

#include <cmath>

namespace alhazen::impl {

namespace {

constexpr int window_radius = 5;  ///< a window of 11 x 11
constexpr double window_sigma = 1.5;

// (K1 L)^2 and (K2 L)^2 for K1 = 0.01, K2 = 0.03 and a dynamic range L of 1.
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;

std::vector<double> window() {
  std::vector<double> kernel = sample_kernel<double>(
      window_radius, [](double x) { return std::exp(-x * x / (2 * window_sigma * window_sigma)); });
  double sum = 0;
  for (const double value : kernel) sum += value;
  for (double& value : kernel) value /= sum;
  return kernel;
}

/// Mean over the window of the product of two planes.
Plane<double> mean_product(const Plane<double>& a, const Plane<double>& b, const std::vector<double>& kernel) {
  Plane<double> product(a.width, a.height);
  for (size_t i = 0; i < product.values.size(); ++i) product.values[i] = a.values[i] * b.values[i];
  return convolve(product, kernel, kernel);
}

}  // namespace

size_t ssim_margin(size_t extent) { return extent > 2 * window_radius ? window_radius : 0; }

Plane<double> ssim_map(const Plane<double>& a, const Plane<double>& b) {
  const std::vector<double> kernel = window();
  const Plane<double> mean_a = convolve(a, kernel, kernel), mean_b = convolve(b, kernel, kernel);
  const Plane<double> mean_aa = mean_product(a, a, kernel), mean_bb = mean_product(b, b, kernel);
  const Plane<double> mean_ab = mean_product(a, b, kernel);
  Plane<double> map(a.width, a.height);
  for (size_t i = 0; i < map.values.size(); ++i) {
    const double ma = mean_a.values[i], mb = mean_b.values[i];
    const double variance_a = mean_aa.values[i] - ma * ma, variance_b = mean_bb.values[i] - mb * mb;
    const double covariance = mean_ab.values[i] - ma * mb;
    map.values[i] =
        (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
  }
  return map;
}

}  // namespace alhazen::impl
