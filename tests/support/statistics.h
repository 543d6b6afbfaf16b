#pragma once

// Means, variances and tests of them: normal, Student's t, Welch, and Sidak's correction for many tests at once.

#include <cmath>
#include <cstddef>
#include <limits>

namespace alhazen::impl::test {

/// Running mean and variance (Welford 1962).
class Moments {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / static_cast<double>(count_);
    m2_ += delta * (x - mean_);
  }

  size_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Returns the unbiased estimate of the variance of the population.
  double variance() const { return count_ > 1 ? m2_ / static_cast<double>(count_ - 1) : 0; }
  /// Returns the variance of the mean.
  double variance_of_mean() const { return count_ > 0 ? variance() / static_cast<double>(count_) : 0; }
  double standard_error() const { return std::sqrt(variance_of_mean()); }

 private:
  size_t count_ = 0;
  double mean_ = 0, m2_ = 0;
};

/// Returns the significance level of each of `cases` independent tests with which all of them together have the level
/// `alpha`.
inline double sidak(double alpha, size_t cases) { return -std::expm1(std::log1p(-alpha) / static_cast<double>(cases)); }

/// Returns the probability that a standard normal variable is at least as far from 0 as z.
inline double normal_p_value(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

/// Returns the regularized incomplete beta function I_x(a, b), by Lentz's continued fraction (Press et al., Numerical
/// Recipes 3rd ed., 6.4).
inline double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
  const auto not_zero = [](double v) { return std::abs(v) < 1e-300 ? 1e-300 : v; };
  double c = 1, d = 1 / not_zero(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / not_zero(1 + even * d);
    c = not_zero(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / not_zero(1 + odd * d);
    c = not_zero(1 + odd / c);
    const double step = d * c;
    fraction *= step;
    if (std::abs(step - 1) < 1e-15) break;
  }
  return front * fraction;
}

/// Returns the probability that a variable with Student's distribution is at least as far from 0 as t.
inline double student_p_value(double t, double degrees_of_freedom) {
  return incomplete_beta(degrees_of_freedom / 2, 0.5, degrees_of_freedom / (degrees_of_freedom + t * t));
}

/// Returns the p-value of the two-sided test that the samples have the mean `expected`. `rounding` bounds the effect of
/// arithmetic on the mean; it is the tolerance if the samples have no variance.
inline double mean_p_value(const Moments& samples, double expected, double rounding) {
  const double distance = std::abs(samples.mean() - expected) - rounding;
  if (distance <= 0) return 1;
  if (!(samples.variance() > 0)) return 0;
  return student_p_value(distance / samples.standard_error(), static_cast<double>(samples.count() - 1));
}

/// Returns the p-value of the two-sided test that two sets of samples have the same mean, whatever their variances
/// (Welch 1947).
inline double welch_p_value(const Moments& a, const Moments& b, double rounding) {
  const double distance = std::abs(a.mean() - b.mean()) - rounding;
  if (distance <= 0) return 1;
  const double va = a.variance_of_mean(), vb = b.variance_of_mean();
  if (!(va + vb > 0)) return 0;
  const double degrees_of_freedom =
      (va + vb) * (va + vb) /
      (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return student_p_value(distance / std::sqrt(va + vb), degrees_of_freedom);
}

}  // namespace alhazen::impl::test
