#pragma once

// Figure 3 of the report: the mean number of bounces (segments of a path) of every thread of a GPU, one thread a pixel
// (Algorithm 6) and one thread for the same place of every chunk (Algorithm 7). The work is a property of scene and
// schedule, so no GPU is needed to know it.

#include <cstdint>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::study {

/// One value a thread; threads lie in a grid.
struct ThreadGrid {
  int width = 0, height = 0;
  std::vector<float> mean_segments;  ///< of the paths of a thread
  std::vector<double> segments;      ///< all that a thread has, a path a pixel

  double total() const;
  double mean() const;  ///< over all paths
  double largest_mean() const;
  double smallest_mean() const;
  double busiest_over_mean() const;  ///< by `segments`: 1 where all threads have the same work
};

struct WorkPerThread {
  int chunks_x = 4, chunks_y = 4;
  int64_t width = 0, height = 0;
  uint64_t samples_per_pixel = 0;
  double statistic_mean = 0;  ///< as the renderer counts, to compare with
  ThreadGrid naive, chunked;
  bool is_there() const { return !naive.mean_segments.empty(); }
};

/// Inequality of non-negative values: 0 where all are equal, towards 1 where one has everything.
double gini(std::vector<double> values);

/// `bounces` holds the mean segments of each pixel, rows from the top down. A thread (x, y) of the chunked schedule has
/// the pixels (x + i * w, y + j * h), w by h the size of a chunk, rounded up, as kernels/pixel.h has it.
ThreadGrid threads_of(const std::vector<float>& bounces, int width, int height, int chunks_x, int chunks_y);

}  // namespace alhazen::study
