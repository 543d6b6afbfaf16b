#pragma once

// The film: running sums of every pixel, in planes, and what comes out of them.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/film/film_view.h"
#include "images/image.h"
#include "render/settings.h"

namespace alhazen {

/// Bytes that a film of these pixels and layers takes.
template <class Real>
uint64_t film_bytes(const PixelWindow& window, const AovSet& aovs, bool weighted);

template <class Real>
class Film {
 public:
  Film(const PixelWindow& window, const AovSet& aovs, bool weighted);
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Adds a block to pixel (x, y) of the whole picture. Blocks of a pixel come in the order of their samples.
  void add(int x, int y, const BlockSum<Real>& block) { view_.add(index_of(x, y), block); }

  const PixelWindow& window() const { return window_; }
  /// How many samples pixel (x, y) of the whole picture holds.
  uint32_t samples_at(int x, int y) const { return samples_[index_of(x, y)]; }
  /// The most that a pixel holds.
  uint32_t most_samples() const { return *std::max_element(samples_.begin(), samples_.end()); }
  std::vector<std::string> channels() const;
  /// Row y (0 is the window's first) of all channels, one after the other: means over the samples taken so far.
  void resolve_row(int y, std::span<float> row) const;
  /// The planes where they lie, for a backend that keeps copies of them elsewhere.
  FilmView<Real> view() const { return view_; }
  /// The planes as bytes, for checkpoints and copies: each of them once, always in the same order, those that nobody
  /// asked for with no bytes.
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
#define ALHAZEN_PLANE(type, name) std::vector<type> name##_;
  ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  FilmView<Real> view_;
};

}  // namespace alhazen
