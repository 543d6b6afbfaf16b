#pragma once

// The film: running sums of every pixel, in planes, and the image computed from them.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/film/film_view.h"
#include "images/image.h"
#include "render/image_layers.h"
#include "render/settings.h"

namespace alhazen::impl {

/// What a film sums besides radiance and its layers: the weights of the pixel filter, what a noise target, a denoiser
/// and path guiding need, and the channel A. Guiding needs the weights.
struct FilmExtras {
  bool weights = false, noise_target = false, denoising = false, guiding = false, alpha = false;
};

/// Bytes that a film with these pixels and layers takes.
template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras = {});

template <class Real>
class Film {
 public:
  Film(const PixelWindow& window, const AovSet& aovs, const FilmExtras& extras = {});
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Adds a block to pixel (x, y) of the whole image. The blocks of a pixel must be added in the order of their
  /// samples.
  void add(int x, int y, const BlockSum<Real>& block) { view_.add(index_of(x, y), block); }

  const PixelWindow& window() const { return window_; }
  /// Number of samples that pixel (x, y) of the whole image holds.
  uint32_t samples_at(int x, int y) const { return samples_[index_of(x, y)]; }
  /// Whether no more samples are taken at pixel (x, y) of the whole image.
  bool is_finished(int x, int y) const { return view_.is_finished(index_of(x, y)); }
  /// Number of pixels x0 <= x < x1, y0 <= y < y1 of the whole image that are not finished.
  uint64_t unfinished(int x0, int x1, int y0, int y1) const;
  uint64_t unfinished() const { return unfinished(window_.x0, window_.x1, window_.y0, window_.y1); }
  /// Samples of all pixels together, of each at most `limit`.
  uint64_t total_samples(uint32_t limit) const;
  uint64_t pixels_without_samples() const;
  /// Whether every pixel that is not finished has so many.
  bool has_samples(uint32_t count) const;
  /// The largest number of samples in any pixel.
  uint32_t max_samples() const { return *std::max_element(samples_.begin(), samples_.end()); }
  /// For guiding: by how much samples of the last iteration count, and that another one begins.
  void set_weight(Real weight) { view_.iteration_weight = weight; }
  void end_iteration();
  /// Changes whenever sums change other than by add().
  uint64_t generation() const { return generation_; }
  /// What layers say of the scene; before it is set, they know neither its camera nor its names.
  void set_scene(LayerScene scene) { scene_ = std::move(scene); }
  const LayerScene& scene() const { return scene_; }
  std::vector<std::string> channels() const;
  /// Computes row y (0 is the window's first) of all channels, one after the other: means over the samples so far.
  void resolve_row(int y, std::span<float> row) const;
  /// The planes in place, for a backend that keeps copies of them elsewhere.
  FilmView<Real> view() const { return view_; }
  /// Visits the bytes of every plane, for checkpoints and copies, each once and always in the same order; absent planes
  /// have no bytes.
  template <class Visit>
  void visit_planes(const Visit& visit) {
#define ALHAZEN_PLANE(type, name) visit(name##_.data(), name##_.size() * sizeof(type));
    ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  }

 private:
  size_t index_of(int x, int y) const {
    return static_cast<size_t>(y - window_.y0) * static_cast<size_t>(window_.width()) +
           static_cast<size_t>(x - window_.x0);
  }

  PixelWindow window_;
  AovSet aovs_;
  bool has_alpha_;
  LayerScene scene_;
#define ALHAZEN_PLANE(type, name) std::vector<type> name##_;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  FilmView<Real> view_;
  uint64_t generation_ = 0;
};

}  // namespace alhazen::impl
