#pragma once

// The arguments of kernels: the scene, the film, and the pixels and samples to take. A kernel is a function object that
// each thread calls once.

#include <concepts>

#include "core/film/film_view.h"
#include "core/integrators/camera_sample.h"
#include "core/sampling/any_sampler.h"

namespace alhazen::impl::cuda {

/// A thread of a two-dimensional launch. x() and y() are its coordinates in the launch, stacks() makes the traversal
/// stacks of its intersector, and add() adds to a total that all threads share.
template <class Thread>
concept PixelThread = requires(const Thread& thread, unsigned long long* total, uint32_t value) {
  { thread.x() } -> std::same_as<uint32_t>;
  { thread.y() } -> std::same_as<uint32_t>;
  thread.stacks();
  thread.add(total, value);
};

/// A thread that can also take work from queues. index() is its index in a one-dimensional launch. increment()
/// atomically adds 1 to a counter that all threads share and returns the previous value.
template <class Thread>
concept QueueThread = PixelThread<Thread> && requires(const Thread& thread, uint32_t* counter) {
  { thread.index() } -> std::same_as<uint32_t>;
  { thread.increment(counter) } -> std::same_as<uint32_t>;
};

/// How a kernel traces rays: `intersector(scene, stacks)` makes a RayIntersector of the thread's stacks.
template <class Tracing>
concept RayTracing = requires {
  { Tracing::by_launch_of_pixels } -> std::convertible_to<bool>;  // whether pixels are all that it can launch
};

/// Selects the rows of a window that one device renders. Bands of rows are assigned to the devices in turn, and each
/// device numbers its rows consecutively.
struct DeviceRows {
  static constexpr uint32_t band = 8;  ///< rows
  uint32_t device = 0, devices = 1;

  /// Returns the row of the window that is row `row` of this device.
  ALHAZEN_HD uint32_t window_row(uint32_t row) const { return (row / band * devices + device) * band + row % band; }
  /// Returns how many rows of a window of `height` rows this device renders.
  ALHAZEN_HD uint32_t rows_of(uint32_t height) const {
    const uint32_t whole = height / (band * devices), rest = height % (band * devices);
    const uint32_t before = device * band;
    return whole * band + (rest <= before ? 0 : rest - before < band ? rest - before : band);
  }
};

/// The work of one launch: samples [first, first + count) of rows [row, row + rows) of a device. `first` is a multiple
/// of samples_per_block.
struct Slice {
  uint32_t row, rows;
  uint32_t first, count;

  ALHAZEN_HD uint32_t blocks() const { return (count + samples_per_block - 1) / samples_per_block; }
};

/// Totals over all launches of a device.
struct Totals {
  unsigned long long samples, rays, shadow_rays, nonfinite;
};

template <class Real>
struct Launch {
  SceneView<Real> scene;
  FilmView<Real> film;
  Totals* totals;
  uint32_t x0, y0;  ///< corner of the film's window in the image
  uint32_t width;   ///< of the window
  DeviceRows device_rows;
  Slice slice;
  SamplerType sampler;
  SampleSeed seed;
  uint32_t max_segments;

  /// Returns the index in the film of column `x` of row `row` of the slice.
  ALHAZEN_HD size_t film_index(uint32_t x, uint32_t row) const {
    return static_cast<size_t>(device_rows.window_row(slice.row + row)) * width + x;
  }
  ALHAZEN_HD uint32_t image_x(uint32_t x) const { return x0 + x; }
  ALHAZEN_HD uint32_t image_y(uint32_t row) const { return y0 + device_rows.window_row(slice.row + row); }
  /// Returns whether block `block` of the slice is not taken at that pixel: because the pixel is finished, or because
  /// the film already contains it. It can if an earlier render was stopped within this pass.
  ALHAZEN_HD bool skips_block(size_t film_pixel, uint32_t block) const {
    return film.is_finished(film_pixel) || film.samples[film_pixel] > slice.first + block * samples_per_block;
  }
  /// Returns the number of samples in a block of the slice: samples_per_block, or fewer in the last block.
  ALHAZEN_HD uint32_t samples_in_block(uint32_t block) const {
    const uint32_t left = slice.count - block * samples_per_block;
    return left < samples_per_block ? left : samples_per_block;
  }
};

/// Adds a finished block to the film and to the totals.
template <PixelThread Thread, class Real>
ALHAZEN_HD void finish_block(const Thread& thread, const Launch<Real>& launch, size_t film_pixel,
                             const BlockSum<Real>& sum) {
  launch.film.add(film_pixel, sum);
  thread.add(&launch.totals->samples, sum.samples);
  thread.add(&launch.totals->rays, sum.segments);
  thread.add(&launch.totals->shadow_rays, sum.shadow_rays);
  if (sum.nonfinite > 0) thread.add(&launch.totals->nonfinite, sum.nonfinite);
}

/// A path record that adds the first hit and point to the block immediately instead of storing them along the path.
template <class Real>
struct SumRecord : PathRecord<Real> {
  BlockSum<Real>* sum;
  WantedRecords wanted;

  ALHAZEN_HD SumRecord(BlockSum<Real>* block, const FilmView<Real>& film) : sum(block), wanted(film.wanted_records()) {}
  ALHAZEN_HD bool wants_first_hit() const { return wanted.first_hit; }
  ALHAZEN_HD bool wants_first_point() const { return wanted.first_point; }
  ALHAZEN_HD void keep_first_hit(const FirstHit<Real>& hit) { sum->add_first_hit(hit); }
  ALHAZEN_HD void keep_first_point(const FirstPoint<Real>& point) { sum->add_first_point(point); }
};

}  // namespace alhazen::impl::cuda
