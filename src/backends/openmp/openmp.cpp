#include "backends/openmp/openmp.h"

#include <omp.h>

#include <algorithm>
#include <optional>
#include <string>

#include "backends/pixel_blocks.h"

namespace alhazen::impl {

namespace {

/// Side of a tile of the strategy `tiles`, in pixels.
constexpr int tile_size = 16;

/// Takes the blocks of one pixel with all threads of a team, then adds them to the film in order.
template <class Real>
void reduce_pixel(const RenderPass<Real>& pass, int x, int y) {
  BlockSum<Real> blocks[default_samples_per_pass / samples_per_block];
  const int first = static_cast<int>(first_block(pass, x, y)), count = static_cast<int>(block_count(pass));
  if (first >= count) return;  // without starting a team
#pragma omp parallel num_threads(pass.settings.threads)
  {
    // A nested parallel region has a team of one thread. Its work counts for the thread of the outer team, which also
    // times it.
    const bool is_nested = omp_get_level() > 1;
    ThreadStatistics& statistics =
        pass.control.thread(is_nested ? omp_get_ancestor_thread_num(1) : omp_get_thread_num());
    std::optional<BusyTimer> timer;
    if (!is_nested) timer.emplace(statistics, false);
    PartedLight<Real> parts_of_block[samples_per_block];
    PartedLight<Real>* const parts = pass.film.view().parts_light() ? parts_of_block : nullptr;
#pragma omp for schedule(static) nowait
    for (int block = first; block < count; ++block) {
      const BlockRequest request = request_block(pass, x, y, static_cast<uint32_t>(block));
      take_requests(pass, &request, 1, &blocks[block], statistics, parts);
    }
  }
  for (int block = first; block < count; ++block) pass.film.add(x, y, blocks[block]);
}

/// Algorithm 4: parallelizes the loop over rows.
template <class Real>
void render_rows(const RenderPass<Real>& pass) {
  const PixelWindow& window = pass.film.window();
#pragma omp parallel num_threads(pass.settings.threads)
  {
    ThreadStatistics& statistics = pass.control.thread(omp_get_thread_num());
    const BusyTimer timer(statistics);
#pragma omp for schedule(runtime) nowait
    for (int y = window.y0; y < window.y1; ++y) {
      if (pass.control.is_stopped()) continue;
      {
        BlockBatch<Real> batch(pass, statistics);
        for (int x = window.x0; x < window.x1; ++x) batch.add_pixel(x, y);
      }
      pass.control.add_samples(pass.film.unfinished(window.x0, window.x1, y, y + 1) * pass.sample_count);
    }
  }
}

/// Algorithm 4 with the loops over rows and columns collapsed into one.
template <class Real>
void render_collapsed(const RenderPass<Real>& pass) {
  const PixelWindow& window = pass.film.window();
#pragma omp parallel num_threads(pass.settings.threads)
  {
    ThreadStatistics& statistics = pass.control.thread(omp_get_thread_num());
    const BusyTimer timer(statistics);
    // One batch for all pixels of the thread: those of a single pixel are few.
    BlockBatch<Real> batch(pass, statistics);
#pragma omp for collapse(2) schedule(runtime) nowait
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x) {
        if (pass.control.is_stopped() || pass.film.is_finished(x, y)) continue;
        batch.add_pixel(x, y);
        pass.control.add_samples(pass.sample_count);
      }
  }
}

/// Algorithm 4 with a parallel reduction over samples inside the parallel loop over rows. All threads already render
/// rows, so OpenMP gives the inner loop a team of one thread, and only its overhead is measured, as in the report.
template <class Real>
void render_rows_with_reduction(const RenderPass<Real>& pass) {
  const PixelWindow& window = pass.film.window();
#pragma omp parallel num_threads(pass.settings.threads)
  {
    const BusyTimer timer(pass.control.thread(omp_get_thread_num()));
#pragma omp for schedule(runtime) nowait
    for (int y = window.y0; y < window.y1; ++y) {
      if (pass.control.is_stopped()) continue;
      for (int x = window.x0; x < window.x1; ++x) reduce_pixel(pass, x, y);
      pass.control.add_samples(pass.film.unfinished(window.x0, window.x1, y, y + 1) * pass.sample_count);
    }
  }
}

/// Parallelizes only the reduction over the samples of each pixel.
template <class Real>
void render_with_reduction(const RenderPass<Real>& pass) {
  const PixelWindow& window = pass.film.window();
  for (int y = window.y0; y < window.y1; ++y) {
    if (pass.control.is_stopped()) return;
    for (int x = window.x0; x < window.x1; ++x) reduce_pixel(pass, x, y);
    pass.control.add_samples(pass.film.unfinished(window.x0, window.x1, y, y + 1) * pass.sample_count);
  }
}

/// Parallelizes the loop over square tiles, so that one thread traces neighbouring rays.
template <class Real>
void render_tiles(const RenderPass<Real>& pass) {
  const PixelWindow& window = pass.film.window();
  const int columns = (window.width() + tile_size - 1) / tile_size;
  const int rows = (window.height() + tile_size - 1) / tile_size;
#pragma omp parallel num_threads(pass.settings.threads)
  {
    ThreadStatistics& statistics = pass.control.thread(omp_get_thread_num());
    const BusyTimer timer(statistics);
#pragma omp for schedule(runtime) nowait
    for (int tile = 0; tile < columns * rows; ++tile) {
      if (pass.control.is_stopped()) continue;
      const int x0 = window.x0 + tile % columns * tile_size, x1 = std::min(x0 + tile_size, window.x1);
      const int y0 = window.y0 + tile / columns * tile_size, y1 = std::min(y0 + tile_size, window.y1);
      {
        BlockBatch<Real> batch(pass, statistics);
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) batch.add_pixel(x, y);
      }
      pass.control.add_samples(pass.film.unfinished(x0, x1, y0, y1) * pass.sample_count);
    }
  }
}

omp_sched_t openmp_schedule(ScheduleKind kind) {
  switch (kind) {
    case ScheduleKind::static_:
      return omp_sched_static;
    case ScheduleKind::guided:
      return omp_sched_guided;
    case ScheduleKind::dynamic:
      break;
  }
  return omp_sched_dynamic;
}

template <class Real>
void render_by_strategy(const RenderPass<Real>& pass) {
  omp_set_dynamic(0);
  omp_set_max_active_levels(1);
  omp_set_schedule(openmp_schedule(pass.settings.schedule.kind), pass.settings.schedule.chunk);
  switch (static_cast<OpenMpStrategy>(pass.settings.strategy)) {
    case OpenMpStrategy::tiles:
      return render_tiles(pass);
    case OpenMpStrategy::rows:
      return render_rows(pass);
    case OpenMpStrategy::collapse:
      return render_collapsed(pass);
    case OpenMpStrategy::rows_with_reduction:
      return render_rows_with_reduction(pass);
    case OpenMpStrategy::reduction:
      return render_with_reduction(pass);
  }
}

class OpenMpBackend final : public Backend {
 public:
  BackendTraits traits() const override { return {"openmp", openmp_strategies(), "the CPU's cores"}; }
  BackendStatus status() const override {
    return {true, std::to_string(omp_get_num_procs()) + " processors, " + to_string(instruction_sets().back())};
  }
  void render_pass(const RenderPass<float>& pass) override { render_openmp(pass); }
  void render_pass(const RenderPass<double>& pass) override { render_openmp(pass); }
};

}  // namespace

std::vector<std::string> openmp_strategies() { return {"tiles", "rows", "collapse", "rows+reduction", "reduction"}; }

void render_openmp(const RenderPass<float>& pass) { render_by_strategy(pass); }
void render_openmp(const RenderPass<double>& pass) { render_by_strategy(pass); }

std::unique_ptr<Backend> make_openmp_backend() { return std::make_unique<OpenMpBackend>(); }

}  // namespace alhazen::impl
