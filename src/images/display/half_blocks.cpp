#include "images/display/half_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace alhazen::impl {

namespace {

/// Which pixels a smaller one covers, and how much of the first and the last of them.
struct Cover {
  int first = 0, last = 0;  ///< inclusive
  double begin = 0, end = 0;

  double weight(int i) const { return std::min(i + 1.0, end) - std::max<double>(i, begin); }
};

Cover cover_of(int pixel, int size, int reduced) {
  const double begin = static_cast<double>(pixel) * size / reduced, end = (pixel + 1.0) * size / reduced;
  const int first = std::min(static_cast<int>(begin), size - 1);
  return {first, std::clamp(static_cast<int>(std::ceil(end)) - 1, first, size - 1), begin, end};
}

using Colour = std::array<unsigned, 3>;

Colour encoded(const ReducedImage& image, const DisplayTransform& display, int x, int y) {
  const float* const rgb =
      &image.rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x))];
  const Vec3d shown = display({static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])});
  const auto byte = [](double value) { return static_cast<unsigned>(std::lround(255 * std::clamp(value, 0.0, 1.0))); };
  return {byte(shown.x), byte(shown.y), byte(shown.z)};
}

std::string colour_code(const char* ground, const Colour& colour) {
  return fmt::format("\x1b[{};2;{};{};{}m", ground, colour[0], colour[1], colour[2]);
}

constexpr const char *foreground = "38", *background = "48", *upper_half = "\u2580", *plain = "\x1b[0m";

}  // namespace

ReducedImage reduce_image(const ImageSource& source, int max_width, int max_height) {
  const double scale =
      std::min({1.0, static_cast<double>(max_width) / source.width, static_cast<double>(max_height) / source.height});
  const auto scaled = [&](int size) { return std::max(1, static_cast<int>(std::lround(size * scale))); };
  ReducedImage reduced{scaled(source.width), scaled(source.height), {}};
  const std::array<size_t, 3> channels = rgb_channels("an image for a terminal", source);
  const auto width = static_cast<size_t>(source.width);
  const auto reduced_width = static_cast<size_t>(reduced.width);
  reduced.rgb.resize(3 * reduced_width * static_cast<size_t>(reduced.height));
  std::vector<float> row(source.channels.size() * width);
  std::vector<double> sums(3 * reduced_width);
  for (int y = 0; y < reduced.height; ++y) {
    const Cover rows = cover_of(y, source.height, reduced.height);
    std::fill(sums.begin(), sums.end(), 0.0);
    for (int j = rows.first; j <= rows.last; ++j) {
      source.fill_row(j, row);
      for (int x = 0; x < reduced.width; ++x) {
        const Cover columns = cover_of(x, source.width, reduced.width);
        for (int i = columns.first; i <= columns.last; ++i)
          for (size_t c = 0; c < 3; ++c) {
            const double value = static_cast<double>(row[channels[c] * width + static_cast<size_t>(i)]);
            if (std::isfinite(value))
              sums[3 * static_cast<size_t>(x) + c] += rows.weight(j) * columns.weight(i) * value;
          }
      }
    }
    const double area = static_cast<double>(source.width) / reduced.width * source.height / reduced.height;
    for (size_t i = 0; i < sums.size(); ++i)
      reduced.rgb[static_cast<size_t>(y) * sums.size() + i] = static_cast<float>(sums[i] / area);
  }
  return reduced;
}

ReducedImage reduce_image(const ReducedImage& image, int max_width, int max_height) {
  const auto fill_row = [&](int y, std::span<float> row) {
    const auto width = static_cast<size_t>(image.width);
    for (size_t i = 0; i < 3 * width; ++i)
      row[i % 3 * width + i / 3] = image.rgb[static_cast<size_t>(y) * 3 * width + i];
  };
  return reduce_image(ImageSource{image.width, image.height, {"R", "G", "B"}, fill_row}, max_width, max_height);
}

std::vector<std::string> terminal_lines(const ReducedImage& image, const DisplayTransform& display, bool half_blocks) {
  std::vector<std::string> lines;
  for (int y = 0; y < image.height; y += 2) {
    std::string line;
    std::string colours;  // of the character before
    for (int x = 0; x < image.width; ++x) {
      const Colour upper = encoded(image, display, x, y);
      const bool is_whole = y + 1 < image.height;
      const Colour lower = is_whole ? encoded(image, display, x, y + 1) : upper;
      Colour mean;
      for (size_t c = 0; c < 3; ++c) mean[c] = (upper[c] + lower[c] + 1) / 2;
      std::string wanted;
      if (!half_blocks)
        wanted = colour_code(background, mean);
      else
        wanted = colour_code(foreground, upper) + (is_whole ? colour_code(background, lower) : "");
      if (wanted != colours) line += wanted;
      colours = wanted;
      line += half_blocks ? upper_half : " ";
    }
    lines.push_back(line + plain);
  }
  return lines;
}

}  // namespace alhazen::impl
