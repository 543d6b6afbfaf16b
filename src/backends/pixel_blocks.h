#pragma once

// What the CPU backends share: the blocks of one pixel, counted and timed.

#include <chrono>

#include "render/backend.h"

namespace alhazen {

/// Adds the time from its making to its end to a thread's busy seconds.
class BusyTimer {
 public:
  explicit BusyTimer(ThreadStatistics& statistics) : statistics_(statistics), start_(Clock::now()) {}
  ~BusyTimer() { statistics_.busy_seconds += std::chrono::duration<double>(Clock::now() - start_).count(); }
  BusyTimer(const BusyTimer&) = delete;
  BusyTimer& operator=(const BusyTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  ThreadStatistics& statistics_;
  Clock::time_point start_;
};

template <class Real>
uint32_t block_count(const RenderPass<Real>& pass) {
  return (pass.sample_count + samples_per_block - 1) / samples_per_block;
}

/// The block to begin with at pixel (x, y): a pixel that the pass had reached when the render was stopped holds some.
template <class Real>
uint32_t first_block(const RenderPass<Real>& pass, int x, int y) {
  const uint32_t held = pass.film.samples_at(x, y);
  return held > pass.first_sample ? (held - pass.first_sample) / samples_per_block : 0;
}

/// Takes block `block` of the pass at pixel (x, y).
template <class Real>
BlockSum<Real> take_block(const RenderPass<Real>& pass, int x, int y, uint32_t block, ThreadStatistics& statistics) {
  const uint32_t offset = block * samples_per_block;
  const uint32_t left = pass.sample_count - offset;
  const BlockSum<Real> sum = pass.kernel(pass.scene.view, pass.settings.seed, pass.settings.max_segments,
                                         static_cast<uint32_t>(x), static_cast<uint32_t>(y), pass.first_sample + offset,
                                         left < samples_per_block ? left : samples_per_block);
  statistics.samples += sum.samples;
  statistics.rays += sum.segments;
  statistics.shadow_rays += sum.shadow_rays;
  statistics.nonfinite_samples += sum.nonfinite;
  return sum;
}

/// The pass at pixel (x, y); nothing where the render is to stop.
template <class Real>
void render_pixel(const RenderPass<Real>& pass, int x, int y, ThreadStatistics& statistics) {
  if (pass.control.is_stopped()) return;
  for (uint32_t block = first_block(pass, x, y); block < block_count(pass); ++block)
    pass.film.add(x, y, take_block(pass, x, y, block, statistics));
}

}  // namespace alhazen
