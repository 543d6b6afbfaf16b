#pragma once

// The report's kernels: one thread per pixel (Algorithm 6), and one thread for the pixels at the same position in every
// chunk of the image (Algorithm 7). Algorithm 6 is the case of a single chunk, so one kernel implements both.

#include "backends/cuda/kernels/launch.h"

namespace alhazen::impl::cuda {

/// Thread (x, y) renders pixel (x, y) of each of chunks_x * chunks_y chunks. Chunk sizes are rounded up and pixels
/// outside the slice are skipped, so that no pixel is lost if the chunks do not divide the image evenly.
template <RayTracing Tracing, IntegratorKind kind, class Real>
struct PixelKernel {
  Launch<Real> launch;
  uint32_t chunks_x, chunks_y;
  BlockSum<Real>* sums;  ///< one per thread

  ALHAZEN_HD uint32_t chunk_width() const { return (launch.width + chunks_x - 1) / chunks_x; }
  ALHAZEN_HD uint32_t chunk_height() const { return (launch.slice.rows + chunks_y - 1) / chunks_y; }

  template <PixelThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const uint32_t x = thread.x(), y = thread.y();
    if (x >= chunk_width() || y >= chunk_height()) return;
    BlockSum<Real>& sum = sums[static_cast<size_t>(y) * chunk_width() + x];
    for (uint32_t row = y; row < launch.slice.rows; row += chunk_height())
      for (uint32_t column = x; column < launch.width; column += chunk_width()) render_pixel(thread, column, row, sum);
  }

 private:
  template <PixelThread Thread>
  ALHAZEN_HD void render_pixel(const Thread& thread, uint32_t x, uint32_t row, BlockSum<Real>& sum) const {
    const size_t film_pixel = launch.film_index(x, row);
    for (uint32_t block = 0; block < launch.slice.blocks(); ++block) {
      if (launch.skips_block(film_pixel, block)) continue;
      sum.begin(launch.film.needs_layer_sums());
      for (uint32_t i = 0; i < launch.samples_in_block(block); ++i)
        take_sample(thread, x, row, launch.slice.first + block * samples_per_block + i, sum);
      finish_block(thread, launch, film_pixel, sum);
    }
  }

  template <PixelThread Thread>
  ALHAZEN_HD void take_sample(const Thread& thread, uint32_t x, uint32_t row, uint32_t sample,
                              BlockSum<Real>& sum) const {
    const auto intersector = Tracing::intersector(launch.scene, thread.stacks());
    const uint32_t px = launch.image_x(x), py = launch.image_y(row);
    const AnySampler sampler(launch.sampler, launch.seed, px, py, sample);
    const CameraSample<Real> camera = sample_camera(launch.scene, sampler, px, py);
    SumRecord<Real> record(&sum, launch.film);
    PartedLight<Real> parts;
    if (launch.film.parts_light()) record.parts = &parts;
    StateOf<kind, Real> path;
    path.ray = camera.ray;
    TrailOf<kind, Real> trail;
    while (take_segment(launch.scene, intersector, sampler, launch.max_segments, path, record, trail)) {
    }
    learn_from_path(launch.scene, trail, record.radiance);
    record.expose(launch.scene.exposure);
    sum.add_path(record, camera.filter_weight);
  }
};

}  // namespace alhazen::impl::cuda
