#include "images/display/exposure_meter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "images/display/display_error.h"

namespace alhazen::impl {

namespace {

/// The fraction of an image that surfaces must cover at least to be what it is exposed for.
constexpr double min_covered = 1e-3;

constexpr double middle_grey = 0.18, darkest_part = 0.1, brightest_part = 0.05, white_part = 0.1;

/// 1 in the middle of the axis, 0 at its ends.
double axis_weight(int i, int count) {
  const double x = (2 * i + 1.0) / count - 1, fall = 1 - x * x;
  return fall * fall;
}

}  // namespace

void ExposureMeter::Histogram::add(float value, double weight) {
  if (!(value > 0) || !std::isfinite(value) || !(weight > 0)) return;
  weights_[std::bit_cast<uint32_t>(value) >> (23 - mantissa_bits)] += weight;
  total_ += weight;
}

/// The middle of the bin.
double ExposureMeter::Histogram::value_of(size_t bin) {
  const uint32_t bits = static_cast<uint32_t>(bin) << (23 - mantissa_bits) | 1u << (22 - mantissa_bits);
  return static_cast<double>(std::bit_cast<float>(bits));
}

double ExposureMeter::Histogram::quantile(double fraction) const {
  double below = 0;
  for (size_t bin = 0; bin < weights_.size(); ++bin) {
    below += weights_[bin];
    if (below > 0 && below >= fraction * total_) return value_of(bin);
  }
  return 0;
}

double ExposureMeter::Histogram::mean_log2(double low, double high) const {
  double below = 0, sum = 0, weights = 0;
  for (size_t bin = 0; bin < weights_.size(); ++bin) {
    if (weights_[bin] == 0) continue;
    const double above = below + weights_[bin];
    const double inside = std::min(above, high * total_) - std::max(below, low * total_);
    if (inside > 0) {
      sum += inside * portable_log2(value_of(bin));
      weights += inside;
    }
    below = above;
  }
  return weights > 0 ? sum / weights : 0;
}

void ExposureMeter::Histograms::add(const Vec3d& radiance, double weight) {
  luminance.add(static_cast<float>(impl::luminance(radiance)), weight);
  brightest_channel.add(static_cast<float>(max_component(radiance)), weight);
}

ExposureMeter::ExposureMeter(int width, int height, bool knows_coverage)
    : width_(width), height_(height), knows_coverage_(knows_coverage) {}

double ExposureMeter::central_weight(int x, int y) const { return axis_weight(x, width_) * axis_weight(y, height_); }

void ExposureMeter::add(int x, int y, const Vec3d& radiance, double coverage) {
  if (!is_finite(radiance)) return;
  if (knows_coverage_) covered_.add(radiance, coverage);
  central_.add(radiance, central_weight(x, y));
}

bool ExposureMeter::uses_coverage() const {
  return knows_coverage_ && covered_.luminance.total() > min_covered * width_ * height_;
}

double ExposureMeter::weight(int x, int y, double coverage) const {
  return uses_coverage() ? coverage : central_weight(x, y);
}

double ExposureMeter::quantile(double fraction) const { return counted().luminance.quantile(fraction); }

double ExposureMeter::fitting() const {
  const double median = counted().brightest_channel.quantile(0.5);
  return median > 3 ? -std::round(portable_log2(median / 0.6)) : 0;
}

double ExposureMeter::automatic() const {
  const Histogram& luminance = counted().luminance;
  if (!(luminance.total() > 0)) return 0;
  const double grey = portable_log2(middle_grey) - luminance.mean_log2(darkest_part, 1 - brightest_part);
  const double white = -portable_log2(luminance.quantile(1 - white_part));
  const double darkest = grey - (uses_coverage() ? max_darkening : max_unknown_darkening);
  return std::round(10 * std::clamp(white, darkest, grey)) / 10 + 0.0;  // not -0
}

}  // namespace alhazen::impl
