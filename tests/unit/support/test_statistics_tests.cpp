// The tests' own statistics: known values of the distributions, and that they detect errors.

#include <gtest/gtest.h>

#include "support/chi_squared_grid.h"
#include "support/random.h"
#include "support/statistics.h"

namespace alhazen::impl::test {
namespace {

TEST(TestStatistics, ClosedForms) {
  for (const double x : {0.1, 1.0, 3.0, 12.0}) {
    EXPECT_NEAR(chi_squared_p_value(x, 1), std::erfc(std::sqrt(x / 2)), 1e-13);
    EXPECT_NEAR(chi_squared_p_value(x, 2), std::exp(-x / 2), 1e-13);
    EXPECT_NEAR(chi_squared_p_value(x, 6), std::exp(-x / 2) * (1 + x / 2 + x * x / 8), 1e-13);
    EXPECT_NEAR(student_p_value(x, 1), 1 - 2 / pi<double> * std::atan(x), 1e-13);
    EXPECT_NEAR(student_p_value(-x, 2), 1 - x / std::sqrt(2 + x * x), 1e-13);
    EXPECT_NEAR(student_p_value(x, 1e7), normal_p_value(x), 1e-6);
  }
  // With many degrees of freedom the cube root of chi-squared is approximately normal (Wilson and Hilferty 1931).
  for (const double x : {3800.0, 4095.0, 4500.0}) {
    const double z = (std::cbrt(x / 4095) - (1 - 2 / (9 * 4095.0))) / std::sqrt(2 / (9 * 4095.0));
    EXPECT_NEAR(chi_squared_p_value(x, 4095), 0.5 * std::erfc(z / std::sqrt(2.0)), 1e-5);
  }
  EXPECT_NEAR(normal_p_value(1.959963984540054), 0.05, 1e-12);
  EXPECT_NEAR(sidak(0.01, 1), 0.01, 1e-15);
  EXPECT_NEAR(std::pow(1 - sidak(0.01, 50), 50), 0.99, 1e-12);
}

TEST(TestStatistics, Moments) {
  Moments moments;
  for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) moments.add(x);
  EXPECT_DOUBLE_EQ(moments.mean(), 5);
  EXPECT_DOUBLE_EQ(moments.variance(), 32.0 / 7);
}

TEST(TestStatistics, SmallBinsArePooled) {
  const ChiSquared test = chi_squared_test({1, 0, 2, 1, 1, 10, 20}, {1, 1, 1, 1, 1, 10, 20});
  EXPECT_EQ(test.pooled, 5u);
  EXPECT_DOUBLE_EQ(test.degrees_of_freedom, 2);
  EXPECT_DOUBLE_EQ(test.statistic, 0);
  EXPECT_DOUBLE_EQ(test.p_value, 1);
}

/// Under the null hypothesis p-values are uniform; a density that is wrong by a tenth on a tenth of the range is
/// detected.
TEST(TestStatistics, ChiSquaredFindsWhatIsWrong) {
  Random random(1);
  int below_a_tenth = 0;
  for (int trial = 0; trial < 400; ++trial) {
    UniformGrid grid(32, 1);
    for (int i = 0; i < 3200; ++i) grid.add(random.uniform<double>());
    below_a_tenth += grid.test().p_value < 0.1;
  }
  EXPECT_NEAR(below_a_tenth, 40, 25);
  UniformGrid wrong(32, 1);
  for (int i = 0; i < 1'000'000; ++i) {
    const double u = random.uniform<double>();
    wrong.add(u < 0.01 ? 0.1 * random.uniform<double>() : u);
  }
  EXPECT_LT(wrong.test().p_value, 1e-6);
}

TEST(TestStatistics, MeansThatDifferAreFound) {
  Random random(2);
  Moments a, b, c;
  for (int i = 0; i < 10'000; ++i) {
    a.add(random.uniform<double>());
    b.add(random.uniform<double>());
    c.add(random.uniform<double>() + 0.03);
  }
  EXPECT_GT(welch_p_value(a, b, 0), 0.001);
  EXPECT_LT(welch_p_value(a, c, 0), 1e-6);
  EXPECT_GT(mean_p_value(a, 0.5, 0), 0.001);
  EXPECT_LT(mean_p_value(c, 0.5, 0), 1e-6);
}

}  // namespace
}  // namespace alhazen::impl::test
