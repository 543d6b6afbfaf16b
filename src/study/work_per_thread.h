#pragma once

// Figure 3 of the report: the mean number of bounces (segments of a path) of every GPU thread, with one thread per
// pixel (Algorithm 6) and one thread for corresponding pixels of all chunks (Algorithm 7). The work depends only on
// scene and schedule, so no GPU is needed to compute it.

#include <cstdint>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::impl::study {

/// One value per thread; threads form a grid.
struct ThreadGrid {
  int width = 0, height = 0;
  std::vector<float> mean_segments;  ///< of the paths of a thread
  std::vector<double> segments;      ///< total of a thread, with one path per pixel

  double total() const;
  double mean() const;  ///< over all paths
  double largest_mean() const;
  double smallest_mean() const;
  double busiest_over_mean() const;  ///< by `segments`: 1 if all threads have equal work
};

struct WorkPerThread {
  int chunks_x = 4, chunks_y = 4;
  int64_t width = 0, height = 0;
  uint64_t samples_per_pixel = 0;
  double statistic_mean = 0;  ///< as counted by the renderer, for comparison
  ThreadGrid naive, chunked;
  bool is_there() const { return !naive.mean_segments.empty(); }
};

/// Inequality of non-negative values: 0 if all are equal, towards 1 if one has everything.
double gini(std::vector<double> values);

/// `bounces` holds the mean segments of each pixel, rows from the top down. In the chunked schedule thread (x, y)
/// renders the pixels (x + i * w, y + j * h), where w by h is the size of a chunk, rounded up, as in kernels/pixel.h.
ThreadGrid threads_of(const std::vector<float>& bounces, int width, int height, int chunks_x, int chunks_y);

}  // namespace alhazen::impl::study
