#pragma once

// Divides a pass into launches of about a quarter of a second each, so that progress, Ctrl-C and time limits work and
// no launch blocks a desktop GPU for long.

#include <algorithm>

#include "backends/cuda/kernels/launch.h"

namespace alhazen::impl::cuda {

class SlicePlan {
 public:
  /// Plans samples [first, first + count) of `rows` rows of `width` pixels. An item is one block of samples of one
  /// pixel. The first slice has about `items` items. No slice has more than `max_items`, unless it is a single band of
  /// rows.
  SlicePlan(uint32_t width, uint32_t rows, uint32_t first, uint32_t count, uint64_t items, uint64_t max_items)
      : width_(width), rows_(rows), first_(first), end_(first + count), items_(items), max_items_(max_items) {}

  bool is_done() const { return sample_ == end_ - first_ || rows_ == 0; }

  Slice next() const {
    const uint64_t items = std::min(items_, max_items_);
    const uint64_t row_items = width_;
    Slice slice{row_, rows_ - row_, first_ + sample_, 0};
    const uint32_t left = end_ - first_ - sample_;
    const uint64_t blocks = row_ == 0 ? std::max<uint64_t>(1, items / (row_items * rows_)) : 1;
    slice.count = static_cast<uint32_t>(std::min<uint64_t>(left, blocks * samples_per_block));
    const uint64_t bands = std::max<uint64_t>(1, items / (row_items * DeviceRows::band));
    slice.rows = static_cast<uint32_t>(std::min<uint64_t>(slice.rows, bands * DeviceRows::band));
    if (slice.rows < rows_) slice.count = std::min(slice.count, samples_per_block);
    return slice;
  }

  /// Continues after `slice`, which took `seconds`, and adapts the size of the next slice.
  void advance(const Slice& slice, double seconds) {
    const double items = static_cast<double>(width_) * slice.rows * slice.blocks();
    const double wanted = items * target_seconds / std::max(seconds, 1e-6);
    items_ = static_cast<uint64_t>(std::clamp(wanted, 0.25 * items, 4 * items));
    row_ += slice.rows;
    if (row_ < rows_) return;
    row_ = 0;
    sample_ += slice.count;
  }

  /// Returns the current number of items per slice, with which the plan of the next pass should start.
  uint64_t items() const { return items_; }

 private:
  static constexpr double target_seconds = 0.25;

  uint32_t width_, rows_;
  uint32_t first_, end_;
  uint64_t items_, max_items_;
  uint32_t row_ = 0, sample_ = 0;
};

}  // namespace alhazen::impl::cuda
