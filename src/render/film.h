#pragma once

// The film: running sums of every pixel, in planes, and what comes out of them.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/integrators/stages.h"
#include "io/images/image.h"
#include "render/settings.h"

namespace alhazen {

/// Sums over a few samples of one pixel.
template <class Real>
struct BlockSum {
  Vec3<Real> radiance{}, albedo{}, normal{};
  Real weight = 0;  ///< of the pixel filter
  Real depth = 0;
  Real luminance_mean = 0, luminance_m2 = 0;  ///< Welford's running mean and sum of squared deviations
  uint32_t samples = 0, hits = 0, segments = 0, shadow_rays = 0, nonfinite = 0;

  void add(const SampleRecord<Real>& sample, Real filter_weight);
};

/// Bytes that a film of these pixels and layers takes.
template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, bool weighted);

template <class Real>
class Film {
 public:
  Film(const PixelWindow& window, const AovSet& aovs, bool weighted);

  /// Adds a block to pixel (x, y) of the whole picture. Blocks of a pixel come in the order of their samples.
  void add(int x, int y, const BlockSum<Real>& block);

  const PixelWindow& window() const { return window_; }
  /// How many samples pixel (x, y) of the whole picture holds.
  uint32_t samples_at(int x, int y) const { return samples_[index_of(x, y)]; }
  /// The most that a pixel holds.
  uint32_t most_samples() const { return *std::max_element(samples_.begin(), samples_.end()); }
  std::vector<std::string> channels() const;
  /// Row y (0 is the window's first) of all channels, one after the other: means over the samples taken so far.
  void resolve_row(int y, std::span<float> row) const;
  /// The planes as bytes, for checkpoints: each of them once, always in the same order.
  template <class Visit>
  void visit_planes(const Visit& visit) {
    visit(radiance_.data(), radiance_.size() * sizeof(radiance_[0]));
    visit(samples_.data(), samples_.size() * sizeof(samples_[0]));
    visit(weights_.data(), weights_.size() * sizeof(Real));
    visit(albedo_.data(), albedo_.size() * sizeof(Vec3<Real>));
    visit(normal_.data(), normal_.size() * sizeof(Vec3<Real>));
    visit(depth_.data(), depth_.size() * sizeof(Real));
    visit(hits_.data(), hits_.size() * sizeof(uint32_t));
    visit(segments_.data(), segments_.size() * sizeof(uint32_t));
    visit(luminance_m2_.data(), luminance_m2_.size() * sizeof(Real));
    visit(luminance_mean_.data(), luminance_mean_.size() * sizeof(Real));
  }

 private:
  size_t index_of(int x, int y) const {
    return static_cast<size_t>(y - window_.y0) * static_cast<size_t>(window_.width()) +
           static_cast<size_t>(x - window_.x0);
  }

  PixelWindow window_;
  AovSet aovs_;
  std::vector<Vec3<Real>> radiance_;
  std::vector<uint32_t> samples_;
  std::vector<Real> weights_;  ///< only where the filter has negative weights; else they are the samples
  std::vector<Vec3<Real>> albedo_, normal_;
  std::vector<Real> depth_;
  std::vector<uint32_t> hits_;
  std::vector<uint32_t> segments_;
  std::vector<Real> luminance_m2_, luminance_mean_;
};

}  // namespace alhazen
