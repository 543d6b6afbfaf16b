#pragma once

// Convolution of a plane with a kernel that is the product of a horizontal and a vertical one.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace alhazen::impl {

/// One value per pixel, rows from the top down.
template <class Real>
struct Plane {
  size_t width = 0, height = 0;
  std::vector<Real> values;

  Plane(size_t columns, size_t rows) : width(columns), height(rows), values(columns * rows) {}
  const Real* row(size_t y) const { return values.data() + y * width; }
  Real* row(size_t y) { return values.data() + y * width; }
};

/// The values of a kernel at -radius to radius.
template <class Real>
std::vector<Real> sample_kernel(int radius, const std::function<double(double)>& value) {
  std::vector<Real> kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(static_cast<Real>(value(i)));
  return kernel;
}

/// Sums kernel[i] * in[x + i - radius] over i, with the ends of the row repeated.
template <class Real>
void filter_row(const Real* in, size_t width, const std::vector<Real>& kernel, std::vector<Real>& padded, Real* out) {
  const size_t radius = kernel.size() / 2;
  padded.resize(width + 2 * radius);
  std::fill_n(padded.begin(), radius, in[0]);
  std::copy_n(in, width, padded.data() + radius);
  std::fill_n(padded.data() + radius + width, radius, in[width - 1]);
  std::fill_n(out, width, Real(0));
  for (size_t i = 0; i < kernel.size(); ++i)
    for (size_t x = 0; x < width; ++x) out[x] += kernel[i] * padded[x + i];
}

/// Kernels have odd sizes and are centred. Pixels beyond the image repeat its border.
template <class Real>
Plane<Real> convolve(const Plane<Real>& in, const std::vector<Real>& horizontal, const std::vector<Real>& vertical) {
  Plane<Real> rows(in.width, in.height), out(in.width, in.height);
  std::vector<Real> padded;
  for (size_t y = 0; y < in.height; ++y) filter_row(in.row(y), in.width, horizontal, padded, rows.row(y));
  const size_t radius = vertical.size() / 2;
  for (size_t y = 0; y < in.height; ++y)
    for (size_t i = 0; i < vertical.size(); ++i) {
      const size_t source = std::min(y + i < radius ? 0 : y + i - radius, in.height - 1);
      const Real* from = rows.row(source);
      Real* to = out.row(y);
      for (size_t x = 0; x < in.width; ++x) to[x] += vertical[i] * from[x];
    }
  return out;
}

}  // namespace alhazen::impl
