#pragma once

// Chooses the exposure of an image by its brightness.

#include <array>
#include <vector>

#include "core/math/vec.h"

namespace alhazen::impl {

/// What decides on an exposure: a number that was given; or the image, which is darkened where it would be
/// overexposed (`fitting`), or is made as bright as a camera would make it (`automatic`).
enum class ExposureRule { given, fitting, automatic };

/// Meters the brightness of an image's pixels. Where it is recorded how much of each pixel is covered by surfaces, the
/// background, which may be far brighter or darker than they are and fill most of the image, does not count; a pixel
/// counts as much as it is covered. Where it is not recorded, or nothing is covered, the middle of the image counts
/// most, as in cameras.
///
/// The results have the same bits on every machine: a noise target may depend on them.
class ExposureMeter {
 public:
  /// `knows_coverage`: add() is told it.
  ExposureMeter(int width, int height, bool knows_coverage);

  /// Adds pixel (x, y), which is `coverage` covered, 0 to 1. Pixels that are black or not finite do not count.
  void add(int x, int y, const Vec3d& radiance, double coverage = 0);

  /// Stops, by whole ones, and 0 or less: where the median of the pixels' brightest channels is above 3, that which
  /// makes it about 0.6.
  double fitting() const;

  /// Stops, by tenths. The mean logarithm of the luminance, without the darkest tenth and the brightest twentieth,
  /// becomes that of middle grey, 0.18. Where more than a tenth would be above white, the image is made darker, until
  /// it is no more than that, by at most `max_darkening` stops, or, where it is not known what is a dark background,
  /// `max_unknown_darkening`.
  double automatic() const;
  static constexpr double max_darkening = 1.5, max_unknown_darkening = 4;

  /// By a rule other than `given`.
  double exposure(ExposureRule rule) const { return rule == ExposureRule::automatic ? automatic() : fitting(); }

  /// How much pixel (x, y) counts. With coverage that is known, it is the coverage.
  double weight(int x, int y, double coverage) const;
  /// Whether pixels count as much as they are covered.
  bool uses_coverage() const;
  /// The luminance that such a fraction of the weights is below; 0 if no pixel counts.
  double quantile(double fraction) const;

 private:
  /// A histogram over the exponent of a float and the first five bits of its mantissa: bins of about 1/32 of a stop.
  class Histogram {
   public:
    void add(float value, double weight);
    double total() const { return total_; }
    double quantile(double fraction) const;
    /// The mean base-2 logarithm of what is between two quantiles.
    double mean_log2(double low, double high) const;

   private:
    static constexpr int mantissa_bits = 5;
    static double value_of(size_t bin);

    std::vector<double> weights_ = std::vector<double>(size_t{1} << (8 + mantissa_bits));
    double total_ = 0;
  };
  struct Histograms {
    Histogram luminance, brightest_channel;
    void add(const Vec3d& radiance, double weight);
  };

  const Histograms& counted() const { return uses_coverage() ? covered_ : central_; }
  double central_weight(int x, int y) const;

  int width_, height_;
  bool knows_coverage_;
  Histograms covered_, central_;
};

}  // namespace alhazen::impl
