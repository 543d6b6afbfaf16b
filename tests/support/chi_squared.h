#pragma once

// Pearson's chi-squared test of counts against expected counts, with small bins pooled.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "support/statistics.h"

namespace alhazen::impl::test {

/// Returns the regularized upper incomplete gamma function Q(a, x): by its series below a + 1, by Lentz's continued
/// fraction above (Press et al., Numerical Recipes 3rd ed., 6.2).
inline double incomplete_gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int i = 1; i < 100000; ++i) {
    const double k = -i * (i - a);
    b += 2;
    d = 1 / (k * d + b);
    c = b + k / c;
    const double step = d * c;
    fraction *= step;
    if (std::abs(step - 1) < 1e-15) break;
  }
  return front * fraction;
}

/// Returns the probability that a chi-squared variable with that many degrees of freedom is at least `statistic`.
inline double chi_squared_p_value(double statistic, double degrees_of_freedom) {
  return incomplete_gamma_q(degrees_of_freedom / 2, statistic / 2);
}

struct ChiSquared {
  double statistic = 0;
  double degrees_of_freedom = 0;
  double p_value = 1;
  size_t pooled = 0;  ///< number of pooled bins
};

inline constexpr double min_expected = 5;

/// Tests counts against expected counts. Bins that expect fewer than `min_expected` are merged, the smallest first,
/// into pools that expect at least that many. The remainder joins the last pool; a pool with expectation 0 must be
/// empty. Both must have the same sum, which removes one degree of freedom.
inline ChiSquared chi_squared_test(const std::vector<double>& observed, const std::vector<double>& expected) {
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  ChiSquared test;
  double bins = 0, pool_observed = 0, pool_expected = 0;
  const auto close_pool = [&] {
    test.statistic += (pool_observed - pool_expected) * (pool_observed - pool_expected) / pool_expected;
    pool_observed = pool_expected = 0;
    ++bins;
  };
  for (const size_t i : order) {
    if (expected[i] < min_expected) ++test.pooled;
    pool_observed += observed[i];
    pool_expected += std::max(expected[i], 0.0);
    if (pool_expected >= min_expected) close_pool();
  }
  // The largest bin completes a pool unless all of them together are too few.
  if (pool_observed > 0) {
    test.p_value = 0;
    return test;
  }
  test.degrees_of_freedom = bins - 1;
  if (bins > 1) test.p_value = chi_squared_p_value(test.statistic, test.degrees_of_freedom);
  return test;
}

}  // namespace alhazen::impl::test
