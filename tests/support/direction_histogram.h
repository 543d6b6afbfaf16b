#pragma once

// Counts directions in bins of polar angle and azimuth, and integrates a density over solid angle over the same bins.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/frame.h"
#include "support/chi_squared.h"

namespace alhazen::impl::test {

/// Bins over the cap of half angle `theta_max` about `frame.normal`, equal in angle. Directions outside the cap, and
/// failed samples, are counted in a bin of their own.
class DirectionHistogram {
 public:
  static constexpr size_t theta_bins = 64, phi_bins = 64;

  DirectionHistogram(const Frame<double>& frame, double theta_max)
      : frame_(frame), theta_max_(theta_max), observed_(theta_bins * phi_bins + 1) {}

  void add(const Vec3d& direction) {
    const Vec3d w = frame_.to_local(direction);
    const double theta = std::atan2(std::hypot(w.x, w.y), w.z), phi = std::atan2(w.y, w.x);
    if (theta > theta_max_) return add_nothing();
    const size_t i = std::min(static_cast<size_t>(theta / theta_max_ * theta_bins), theta_bins - 1);
    const size_t j = std::min(static_cast<size_t>((phi / (2 * pi<double>)+0.5) * phi_bins), phi_bins - 1);
    ++observed_[i * phi_bins + j];
    ++count_;
  }

  void add_nothing() {
    ++observed_.back();
    ++count_;
  }

  /// Tests the counts against `pdf(direction)`; `integral` receives the integral of pdf over the cap.
  template <class Pdf>
  ChiSquared test(const Pdf& pdf, double& integral) const {
    std::vector<double> expected;
    integral = 0;
    for (size_t i = 0; i < theta_bins; ++i)
      for (size_t j = 0; j < phi_bins; ++j) {
        const Cell cell{theta_max_ * static_cast<double>(i) / theta_bins,
                        theta_max_ * static_cast<double>(i + 1) / theta_bins,
                        2 * pi<double> * (static_cast<double>(j) / phi_bins - 0.5),
                        2 * pi<double> * (static_cast<double>(j + 1) / phi_bins - 0.5)};
        const double part_of_cell = refine(pdf, cell, quadrature(pdf, cell), 0);
        integral += part_of_cell;
        expected.push_back(part_of_cell * count_);
      }
    expected.push_back((1 - integral) * count_);
    return chi_squared_test(observed_, expected);
  }

 private:
  struct Cell {
    double theta0, theta1, phi0, phi1;
  };

  /// Five-point Gauss-Legendre quadrature along each angle.
  template <class Pdf>
  double quadrature(const Pdf& pdf, const Cell& cell) const {
    static constexpr std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                                 0.9061798459386640};
    static constexpr std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                                   0.4786286704993665, 0.2369268850561891};
    const double half_theta = (cell.theta1 - cell.theta0) / 2, half_phi = (cell.phi1 - cell.phi0) / 2;
    double sum = 0;
    for (size_t i = 0; i < 5; ++i) {
      const double theta = cell.theta0 + half_theta * (1 + nodes[i]);
      const double sin_theta = std::sin(theta), cos_theta = std::cos(theta);
      for (size_t j = 0; j < 5; ++j) {
        const double phi = cell.phi0 + half_phi * (1 + nodes[j]);
        const Vec3d w = frame_.to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
        sum += weights[i] * weights[j] * sin_theta * static_cast<double>(pdf(w));
      }
    }
    return sum * half_theta * half_phi;
  }

  /// Integrates over a cell, of which `whole` is an estimate: subdivides it until the estimates agree.
  template <class Pdf>
  double refine(const Pdf& pdf, const Cell& cell, double whole, int depth) const {
    const double theta = (cell.theta0 + cell.theta1) / 2, phi = (cell.phi0 + cell.phi1) / 2;
    const std::array<Cell, 4> quarters{
        Cell{cell.theta0, theta, cell.phi0, phi}, Cell{cell.theta0, theta, phi, cell.phi1},
        Cell{theta, cell.theta1, cell.phi0, phi}, Cell{theta, cell.theta1, phi, cell.phi1}};
    std::array<double, 4> parts{};
    double sum = 0;
    for (size_t i = 0; i < 4; ++i) sum += parts[i] = quadrature(pdf, quarters[i]);
    // A fifth of a count among a million, but not below the resolution of float. The corner of a light may be in a cell
    // without containing any of its nodes, so every cell is divided.
    const double tolerance = 2e-7 + 1e-6 * sum;
    if ((std::abs(sum - whole) <= tolerance && depth > 0) || depth == 6) return sum;
    sum = 0;
    for (size_t i = 0; i < 4; ++i) sum += refine(pdf, quarters[i], parts[i], depth + 1);
    return sum;
  }

  Frame<double> frame_;
  double theta_max_;
  std::vector<double> observed_;
  double count_ = 0;
};

}  // namespace alhazen::impl::test
