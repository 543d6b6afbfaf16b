#include "view/noise_curve.h"

#include <cmath>
#include <limits>

namespace alhazen::impl {

double relative_error(const Picture& earlier, const Picture& later) {
  const double n1 = earlier.samples, n2 = later.samples;
  const PictureLayer* const a = earlier.layer("color");
  const PictureLayer* const b = later.layer("color");
  double sum = 0;
  size_t count = 0;
  for (size_t c = 0; c < b->planes.size(); ++c) {
    const float* const one = a->planes[c].data();
    const float* const two = b->planes[c].data();
    for (size_t i = 0; i < b->planes[c].size(); ++i) {
      const double value = static_cast<double>(two[i]), change = value - static_cast<double>(one[i]);
      const double term = change * change / (value * value + 0.01);
      if (!std::isfinite(term)) continue;
      sum += term;
      ++count;
    }
  }
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(sum / static_cast<double>(count) * n1 / (n2 - n1));
}

void NoiseCurve::clear() { *this = {}; }

void NoiseCurve::add(const std::shared_ptr<const Picture>& picture) {
  const PictureLayer* const colour = picture->layer("color");
  if (!colour || !(picture->samples > 0)) return;
  const bool is_other = doubled_ && (doubled_->width != picture->width || doubled_->height != picture->height ||
                                     doubled_->layer("color")->planes.size() != colour->planes.size() ||
                                     doubled_->samples >= picture->samples);
  if (is_other && doubled_->samples == picture->samples) return;
  if (is_other) clear();
  if (!doubled_) doubled_ = picture;
  if (picture->samples >= 2 * doubled_->samples) {
    earlier_ = doubled_;
    doubled_ = picture;
  }
  if (!earlier_) return;
  const double error = relative_error(*earlier_, *picture);
  if (!std::isfinite(error)) return;
  error_ = error;
  points_.push_back({picture->samples, error});
  if (points_.size() <= max_points) return;
  // Every second one goes, and the last stays.
  std::vector<std::array<double, 2>> fewer;
  for (size_t i = points_.size() % 2 == 0 ? 1 : 0; i < points_.size(); i += 2) fewer.push_back(points_[i]);
  points_ = std::move(fewer);
}

}  // namespace alhazen::impl
