#include "images/metrics/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/math/vec.h"
#include "images/codecs/decoders.h"
#include "images/display/colour_map.h"
#include "images/metrics/flip.h"
#include "images/metrics/ssim.h"

namespace alhazen::impl {

namespace {

/// Two images of the same size, compared pixel by pixel.
class Pair {
 public:
  Pair(const Image& a, const Image& b) : a_(a), b_(b) {
    if (a.width != b.width || a.height != b.height)
      throw InputError("the images differ in size: " + size_text(a) + " and " + size_text(b) +
                       "; only images of the same size can be compared");
    if (a.width <= 0 || a.height <= 0) throw InputError("the images have no pixels");
    for (const ColourChannels& channels : {channels_a_, channels_b_})
      if (!channels) throw InputError("an image " + channels.fault + ", so there is nothing to compare");
  }

  size_t width() const { return static_cast<size_t>(a_.width); }
  size_t height() const { return static_cast<size_t>(a_.height); }
  size_t size() const { return width() * height(); }
  Vec3d a(size_t i) const { return colour(a_, channels_a_, i); }
  Vec3d b(size_t i) const { return colour(b_, channels_b_, i); }
  bool counts(size_t i) const { return is_finite(a(i)) && is_finite(b(i)); }

 private:
  static std::string size_text(const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
  }
  static Vec3d colour(const Image& image, const ColourChannels& channels, size_t i) {
    const auto value = [&](int channel) { return static_cast<double>(image.planes[static_cast<size_t>(channel)][i]); };
    return {value(channels.rgb[0]), value(channels.rgb[1]), value(channels.rgb[2])};
  }

  const Image& a_;
  const Image& b_;
  const ColourChannels channels_a_ = colour_channels(a_), channels_b_ = colour_channels(b_);
};

Vec3d clamped(const Vec3d& colour) { return min(max(colour, splat(0.0)), splat(1.0)); }

Vec3d encoded(const Vec3d& colour) {
  const Vec3d c = clamped(colour);
  return {srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z)};
}

double mean_of(const Vec3d& v) { return (v.x + v.y + v.z) / 3; }

/// NaN of no terms, without the sign that 0 / 0 has.
double mean(double sum, double count) { return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN(); }

/// Mean of the terms without the thousandth of them, rounded down, that is largest: a few pixels that a bright path hit
/// then do not decide. Reorders the terms.
double trimmed_mean(std::vector<double>& terms) {
  if (terms.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto end = terms.end() - static_cast<std::ptrdiff_t>(terms.size() / 1000);
  if (end != terms.end()) std::nth_element(terms.begin(), end, terms.end());
  return std::accumulate(terms.begin(), end, 0.0) / static_cast<double>(end - terms.begin());
}

/// Computes the metrics that treat each pixel separately.
void compare_pixels(const Pair& pair, ImageDifference& result) {
  double encoded_mse = 0;
  std::vector<double> relative_errors;
  for (size_t i = 0; i < pair.size(); ++i) {
    const Vec3d a = pair.a(i), b = pair.b(i);
    if (is_finite(a)) result.mean_a += luminance(a);
    if (is_finite(b)) result.mean_b += luminance(b);
    result.nonfinite_a += is_finite(a) ? 0 : 1;
    result.nonfinite_b += is_finite(b) ? 0 : 1;
    result.nonfinite_in_one += is_finite(a) != is_finite(b) ? 1 : 0;
    if (!pair.counts(i)) continue;
    ++result.compared;
    const Vec3d difference = a - b, encoded_difference = encoded(a) - encoded(b);
    result.mse += mean_of(difference * difference);
    relative_errors.push_back(mean_of(difference * difference / (b * b + splat(0.01))));
    result.relmse += relative_errors.back();
    encoded_mse += mean_of(encoded_difference * encoded_difference);
    result.max_abs = std::max(result.max_abs, max_component(abs(difference)));
  }
  const auto pixels = static_cast<double>(result.compared), all = static_cast<double>(pair.size());
  result.mse = mean(result.mse, pixels);
  result.relmse = mean(result.relmse, pixels);
  result.mean_a = mean(result.mean_a, all - static_cast<double>(result.nonfinite_a));
  result.mean_b = mean(result.mean_b, all - static_cast<double>(result.nonfinite_b));
  if (result.compared == 0) result.max_abs = encoded_mse = std::numeric_limits<double>::quiet_NaN();
  result.rmse = std::sqrt(result.mse);
  result.relmse_trimmed = trimmed_mean(relative_errors);
  result.psnr = encoded_mse == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(encoded_mse / pixels);
}

// Invalid pixels are black in both images, so that they add no difference to their neighbours.

double mean_ssim(const Pair& pair) {
  Plane<double> a(pair.width(), pair.height()), b = a;
  for (size_t i = 0; i < pair.size(); ++i)
    if (pair.counts(i)) {
      a.values[i] = srgb_encode(luminance(clamped(pair.a(i))));
      b.values[i] = srgb_encode(luminance(clamped(pair.b(i))));
    }
  const Plane<double> map = ssim_map(a, b);
  const size_t margin_x = ssim_margin(pair.width()), margin_y = ssim_margin(pair.height());
  double sum = 0, count = 0;
  for (size_t y = margin_y; y < pair.height() - margin_y; ++y)
    for (size_t x = margin_x; x < pair.width() - margin_x; ++x)
      if (pair.counts(y * pair.width() + x)) {
        sum += map.row(y)[x];
        ++count;
      }
  return mean(sum, count);
}

Plane<float> flip_of(const Pair& pair) {
  const Plane<float> black(pair.width(), pair.height());
  ColourPlanes a{black, black, black}, b = a;
  for (size_t i = 0; i < pair.size(); ++i) {
    if (!pair.counts(i)) continue;
    const Vec3f colour_a = convert<float>(clamped(pair.a(i))), colour_b = convert<float>(clamped(pair.b(i)));
    for (size_t c = 0; c < 3; ++c) {
      a[c].values[i] = colour_a[static_cast<int>(c)];
      b[c].values[i] = colour_b[static_cast<int>(c)];
    }
  }
  return flip_map(a, b);
}

double mean_flip(const Pair& pair, const Plane<float>& map) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < pair.size(); ++i)
    if (pair.counts(i)) {
      sum += static_cast<double>(map.values[i]);
      ++count;
    }
  return mean(sum, count);
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b) {
  Plane<float> flip_map(0, 0);
  return compare_images(a, b, flip_map);
}

ImageDifference compare_images(const Image& a, const Image& b, Plane<float>& flip_map) {
  const Pair pair(a, b);
  ImageDifference result;
  compare_pixels(pair, result);
  result.ssim = mean_ssim(pair);
  flip_map = flip_of(pair);
  result.flip = mean_flip(pair, flip_map);
  return result;
}

Image difference_image(const Image& a, const Image& b) { return error_colours(flip_of(Pair(a, b))); }

Image error_colours(const Plane<float>& errors) {
  Image image{static_cast<int>(errors.width), static_cast<int>(errors.height), {"R", "G", "B"}, {}};
  image.planes.assign(3, std::vector<float>(errors.values.size()));
  for (size_t i = 0; i < errors.values.size(); ++i) {
    const Vec3f colour = convert<float>(error_colour(static_cast<double>(errors.values[i])));
    for (size_t c = 0; c < 3; ++c) image.planes[c][i] = colour[static_cast<int>(c)];
  }
  return image;
}

Image reduced(const Image& image, int factor) {
  if (factor < 1 || factor > std::min(image.width, image.height))
    throw InputError("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                     " cannot be reduced by " + std::to_string(factor));
  Image small{image.width / factor, image.height / factor, image.channels, {}};
  const auto width = static_cast<size_t>(image.width), columns = static_cast<size_t>(small.width),
             rows = static_cast<size_t>(small.height), n = static_cast<size_t>(factor);
  for (const std::vector<float>& plane : image.planes) {
    std::vector<float> means(columns * rows);
    for (size_t y = 0; y < rows; ++y)
      for (size_t x = 0; x < columns; ++x) {
        double sum = 0;
        for (size_t i = 0; i < n * n; ++i) sum += static_cast<double>(plane[(y * n + i / n) * width + x * n + i % n]);
        means[y * columns + x] = static_cast<float>(sum / static_cast<double>(n * n));
      }
    small.planes.push_back(std::move(means));
  }
  return small;
}

}  // namespace alhazen::impl
