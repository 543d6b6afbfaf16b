#include "view/noise_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alhazen::impl::test {

namespace {

constexpr size_t pixels = 5000;

/// Means of so many first samples, for each pixel of the values 1 with the standard deviation 0.5.
class Samples {
 public:
  std::shared_ptr<Picture> picture(int count) {
    for (; taken_ < count; ++taken_)
      for (double& sum : sums_) sum += distribution_(random_);
    auto picture = std::make_shared<Picture>();
    picture->width = static_cast<int>(pixels);
    picture->height = 1;
    picture->samples = count;
    PictureLayer layer{"color", {"R"}, {{}}};
    for (const double sum : sums_) layer.planes[0].push_back(static_cast<float>(sum / count));
    picture->layers.push_back(std::move(layer));
    return picture;
  }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> distribution_{1, 0.5};
  std::vector<double> sums_ = std::vector<double>(pixels);
  int taken_ = 0;
};

}  // namespace

TEST(NoiseCurve, IsTheErrorOfTheLaterPicture) {
  Samples samples;
  for (const auto& [n1, n2] : {std::pair(64, 80), std::pair(128, 256), std::pair(300, 1200)}) {
    const auto earlier = samples.picture(n1), later = samples.picture(n2);
    double squares = 0;
    for (const float value : later->layers[0].planes[0]) squares += std::pow(static_cast<double>(value) - 1, 2) / 1.01;
    const double truth = std::sqrt(squares / pixels);
    EXPECT_NEAR(relative_error(*earlier, *later) / truth, 1, 0.04) << n1 << " " << n2;
  }
}

TEST(NoiseCurve, HasTheErrorOverTheSamples) {
  Samples samples;
  NoiseCurve curve;
  for (int n = 4; n <= 4000; n += 8) {
    curve.add(samples.picture(n));
    ASSERT_LE(curve.points().size(), NoiseCurve::max_points);
  }
  ASSERT_TRUE(curve.error());
  EXPECT_NEAR(*curve.error(), 0.5 / std::sqrt(3996.0 * 1.01), 0.0005);
  const auto& points = curve.points();
  EXPECT_GT(points.size(), NoiseCurve::max_points / 4);
  EXPECT_EQ(points.back()[0], 3996);
  for (size_t i = 1; i < points.size(); ++i) EXPECT_GT(points[i][0], points[i - 1][0]);
  for (const auto& [n, error] : points) EXPECT_NEAR(error * std::sqrt(n * 1.01) / 0.5, 1, 0.35) << n;
  // Of another image nothing is left.
  curve.add(Samples().picture(4));
  EXPECT_FALSE(curve.error());
  EXPECT_TRUE(curve.points().empty());
}

TEST(NoiseCurve, LeavesOutWhatIsNotFinite) {
  Samples samples;
  const auto earlier = samples.picture(64), later = samples.picture(128);
  const double error = relative_error(*earlier, *later);
  later->layers[0].planes[0][3] = INFINITY;
  EXPECT_NEAR(relative_error(*earlier, *later), error, 0.01 * error);
}

}  // namespace alhazen::impl::test
