#pragma once

// How far an image still is from the one with endless samples, by what changes from one picture of it to a later one.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "view/picture.h"

namespace alhazen::impl {

/// The relative error of an image of mean I2 of n2 samples, of which the first n1 have the mean I1. Where a sample has
/// the variance v and samples are independent, I2 - I1 = (n2 - n1) / n2 (J - I1), with J the mean of the others, so
///
///   E (I2 - I1)^2 = ((n2 - n1) / n2)^2 (v / (n2 - n1) + v / n1) = v (1 / n1 - 1 / n2),
///
/// and the error of I2 squared, v / n2, is (I2 - I1)^2 (1 / n2) / (1 / n1 - 1 / n2) = (I2 - I1)^2 n1 / (n2 - n1).
/// Relative to I2, as in relMSE: the root of the mean over pixels and channels of this over I2^2 + 0.01. Samples of
/// Sobol' sequences are better than independent, so the error is overestimated a little.
double relative_error(const Picture& earlier, const Picture& later);

/// The error over the samples of one image.
class NoiseCurve {
 public:
  static constexpr size_t max_points = 200;

  /// Of another image: forgets all.
  void clear();
  /// The image with more samples than before. Pictures without the layer "color" or of another size are left out.
  void add(const std::shared_ptr<const Picture>& picture);

  std::optional<double> error() const { return error_; }
  /// Samples and error.
  const std::vector<std::array<double, 2>>& points() const { return points_; }

 private:
  std::shared_ptr<const Picture> earlier_,
      doubled_;  ///< what the next is compared with, and will be at twice its samples
  std::optional<double> error_;
  std::vector<std::array<double, 2>> points_;
};

}  // namespace alhazen::impl
