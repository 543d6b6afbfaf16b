#pragma once

// Blocks of samples on the CPU backends: requests, batches and statistics.

#include <chrono>
#include <vector>

#include "render/backend.h"
#include "util/processor_time.h"

namespace alhazen::impl {

/// Adds the time between its construction and its destruction to the busy seconds of a thread, and what the thread ran
/// of it to its processor seconds. Both must happen on that thread.
class BusyTimer {
 public:
  /// To read the processor time is a system call: spans of microseconds do without.
  explicit BusyTimer(ThreadStatistics& statistics, bool reads_processor_time = true)
      : statistics_(statistics),
        reads_processor_time_(reads_processor_time),
        processor_start_(reads_processor_time ? thread_processor_seconds() : 0),
        start_(Clock::now()) {}
  ~BusyTimer() {
    statistics_.busy_seconds += std::chrono::duration<double>(Clock::now() - start_).count();
    if (reads_processor_time_) statistics_.processor_seconds += thread_processor_seconds() - processor_start_;
  }
  BusyTimer(const BusyTimer&) = delete;
  BusyTimer& operator=(const BusyTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  ThreadStatistics& statistics_;
  bool reads_processor_time_;
  double processor_start_;
  Clock::time_point start_;
};

template <class Real>
uint32_t block_count(const RenderPass<Real>& pass) {
  return (pass.sample_count + samples_per_block - 1) / samples_per_block;
}

/// Returns the first block to take at pixel (x, y), block_count if there is none. If the render was stopped during this
/// pass and resumed, the film already contains earlier blocks.
template <class Real>
uint32_t first_block(const RenderPass<Real>& pass, int x, int y) {
  if (pass.film.is_finished(x, y)) return block_count(pass);
  const uint32_t held = pass.film.samples_at(x, y);
  return held > pass.first_sample ? (held - pass.first_sample) / samples_per_block : 0;
}

template <class Real>
BlockRequest request_block(const RenderPass<Real>& pass, int x, int y, uint32_t block) {
  const uint32_t offset = block * samples_per_block;
  const uint32_t left = pass.sample_count - offset;
  return {static_cast<uint32_t>(x), static_cast<uint32_t>(y), pass.first_sample + offset,
          left < samples_per_block ? left : samples_per_block};
}

template <class Real>
void take_requests(const RenderPass<Real>& pass, const BlockRequest* requests, uint32_t count, BlockSum<Real>* sums,
                   ThreadStatistics& statistics, PartedLight<Real>* parts) {
  pass.kernel(pass.scene.view, pass.tracer, sample_seed(pass.settings), pass.settings.max_segments, requests, count,
              sums, pass.film.view().wanted_records(), parts);
  for (uint32_t i = 0; i < count; ++i) {
    statistics.samples += sums[i].samples;
    statistics.rays += sums[i].segments;
    statistics.shadow_rays += sums[i].shadow_rays;
    statistics.nonfinite_samples += sums[i].nonfinite;
    if constexpr (counts_samples) statistics.counters.add(sums[i].counters);
  }
}

/// Collects blocks of the pass, takes many of them in one call of the kernel, and adds them to the film in the order in
/// which they were collected.
template <class Real>
class BlockBatch {
 public:
  BlockBatch(const RenderPass<Real>& pass, ThreadStatistics& statistics) : pass_(pass), statistics_(statistics) {
    if (pass.film.view().parts_light()) parts_.resize(max_blocks_per_request * samples_per_block);
  }
  ~BlockBatch() { take(); }
  BlockBatch(const BlockBatch&) = delete;
  BlockBatch& operator=(const BlockBatch&) = delete;

  /// Adds all blocks of pixel (x, y) that have not been taken yet. Once the render is stopped, blocks are dropped.
  void add_pixel(int x, int y) {
    for (uint32_t block = first_block(pass_, x, y); block < block_count(pass_); ++block) {
      if (count_ == max_blocks_per_request) take();
      requests_[count_++] = request_block(pass_, x, y, block);
    }
  }

 private:
  void take() {
    const uint32_t count = count_;
    count_ = 0;
    if (count == 0 || pass_.control.is_stopped()) return;
    take_requests(pass_, requests_, count, sums_, statistics_, parts_.empty() ? nullptr : parts_.data());
    for (uint32_t i = 0; i < count; ++i)
      pass_.film.add(static_cast<int>(requests_[i].x), static_cast<int>(requests_[i].y), sums_[i]);
  }

  const RenderPass<Real>& pass_;
  ThreadStatistics& statistics_;
  uint32_t count_ = 0;
  BlockRequest requests_[max_blocks_per_request];
  BlockSum<Real> sums_[max_blocks_per_request];
  std::vector<PartedLight<Real>> parts_;  ///< if the film divides light into parts
};

}  // namespace alhazen::impl
