#include "study/work_per_thread.h"

#include <algorithm>
#include <numeric>

namespace alhazen::impl::study {

double ThreadGrid::total() const { return std::accumulate(segments.begin(), segments.end(), 0.0); }

double ThreadGrid::mean() const {
  double paths = 0;
  for (size_t i = 0; i < segments.size(); ++i)
    if (mean_segments[i] > 0) paths += segments[i] / static_cast<double>(mean_segments[i]);
  return paths > 0 ? total() / paths : 0;
}

double ThreadGrid::largest_mean() const {
  return static_cast<double>(*std::max_element(mean_segments.begin(), mean_segments.end()));
}

double ThreadGrid::smallest_mean() const {
  return static_cast<double>(*std::min_element(mean_segments.begin(), mean_segments.end()));
}

double ThreadGrid::busiest_over_mean() const {
  const double sum = total();
  return sum > 0 ? *std::max_element(segments.begin(), segments.end()) * static_cast<double>(segments.size()) / sum : 0;
}

double gini(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double weighted = 0, sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    weighted += static_cast<double>(i + 1) * values[i];
    sum += values[i];
  }
  return sum > 0 ? 2 * weighted / (n * sum) - (n + 1) / n : 0;
}

ThreadGrid threads_of(const std::vector<float>& bounces, int width, int height, int chunks_x, int chunks_y) {
  ThreadGrid grid;
  grid.width = (width + chunks_x - 1) / chunks_x;
  grid.height = (height + chunks_y - 1) / chunks_y;
  const size_t threads = static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height);
  grid.segments.assign(threads, 0);
  std::vector<int> pixels(threads, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t thread =
          static_cast<size_t>(y % grid.height) * static_cast<size_t>(grid.width) + static_cast<size_t>(x % grid.width);
      grid.segments[thread] +=
          static_cast<double>(bounces[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)]);
      ++pixels[thread];
    }
  grid.mean_segments.resize(threads);
  for (size_t i = 0; i < threads; ++i)
    grid.mean_segments[i] = static_cast<float>(grid.segments[i] / std::max(1, pixels[i]));
  return grid;
}

}  // namespace alhazen::impl::study
