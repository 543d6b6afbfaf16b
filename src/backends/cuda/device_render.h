#pragma once

// Renders a pass on one device. The scene is uploaded once and the film stays on the device; slices of the pass are
// launched by one of four strategies, and the film is downloaded at the end. A GPU and the host in its place run the
// same code.

#include <chrono>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "backends/cuda/executor.h"
#include "backends/cuda/kernels/persistent.h"
#include "backends/cuda/kernels/pixel.h"
#include "backends/cuda/kernels/wavefront.h"
#include "backends/cuda/slices.h"
#include "backends/cuda/strategy.h"
#include "core/bvh/cwbvh/traversal.h"
#include "render/backend.h"

namespace alhazen::impl::cuda {

/// Traces rays with the binary BVH.
struct Bvh2Tracing {
  static constexpr bool by_launch_of_pixels = false;  ///< whether launching pixels is the only strategy

  template <class Real, StackMaker Stacks>
  ALHAZEN_HD static Bvh2Intersector<Real, Stacks> intersector(const SceneView<Real>& scene, const Stacks& stacks) {
    return Bvh2Intersector<Real, Stacks>(scene, stacks);
  }
};

/// Traces rays with the compressed wide BVH, which exists for float only.
struct CwbvhTracing {
  static constexpr bool by_launch_of_pixels = false;

  template <StackMaker Stacks>
  ALHAZEN_HD static CwbvhIntersector<Stacks> intersector(const SceneView<float>& scene, const Stacks& stacks) {
    return CwbvhIntersector<Stacks>(scene, stacks);
  }
};

template <KernelExecutor Executor, RayTracing Tracing, class Real>
class DeviceRender {
 public:
  DeviceRender(Executor& executor, const DeviceRows& device_rows)
      : executor_(executor),
        device_rows_(device_rows),
        arena_(executor),
        film_(executor),
        totals_(executor),
        sums_(executor),
        slots_memory_(executor),
        guide_(executor),
        guide_sums_(executor),
        counter_(executor) {}

  /// Builds the acceleration structure of executors that have their own, also when the scene has changed.
  void prepare(const CompiledScene<Real>& scene) {
    upload_scene(scene);
    executor_.build(scene.view, device_scene(scene));
  }

  void render_pass(const RenderPass<Real>& pass, ThreadStatistics& statistics) {
    const typename Executor::Range range("pass");
    upload(pass);
    executor_.clear(totals_.data(), sizeof(Totals));
    Launch<Real> launch = launch_of(pass);
    const uint32_t rows = device_rows_.rows_of(static_cast<uint32_t>(pass.film.window().height()));
    SlicePlan plan(launch.width, rows, pass.first_sample, pass.sample_count, items_, max_items(pass));
    while (!plan.is_done() && !pass.control.is_stopped()) {
      launch.slice = plan.next();
      const Clock::time_point start = Clock::now();
      const bool finished = run_slice(pass, launch);
      executor_.wait();
      if (!finished) break;
      plan.advance(launch.slice, std::chrono::duration<double>(Clock::now() - start).count());
      pass.control.add_samples(unfinished(pass.film, launch.slice) * launch.slice.count);
    }
    items_ = plan.items();
    download(pass);
    if (pass.guiding) download_guide(*pass.guiding);
    add_totals(statistics);
  }

 private:
  using Clock = std::chrono::steady_clock;

  // ---- memory of the device -------------------------------------------------------------------------------------

  void upload(const RenderPass<Real>& pass) {
    if (scene_ != &pass.scene || scene_generation_ != pass.scene.generation) upload_scene(pass.scene);
    totals_.reserve(1);
    counter_.reserve(1);
    if (host_film_ != &pass.film || film_generation_ != pass.film.generation()) {
      host_film_ = &pass.film;
      film_generation_ = pass.film.generation();
      upload_film(pass.film);
    }
    if (pass.guiding) upload_guide(*pass.guiding);
    // The host finishes pixels between passes.
    const uint8_t* finished = pass.film.view().finished;
    if (finished) executor_.upload(film_view_.finished, finished, static_cast<size_t>(pass.film.window().pixels()));
  }

  void upload_scene(const CompiledScene<Real>& scene) {
    const typename Executor::Range range("upload the scene");
    const size_t bytes = scene.statistics.bytes;
    arena_.reset();
    arena_.reserve(bytes);
    executor_.upload(arena_.data(), scene.arena.get(), bytes);
    scene_ = &scene;
    scene_generation_ = scene.generation;
  }

  /// Returns the view of the scene with its pointers moved from the host's arena to the device's.
  SceneView<Real> device_scene(const CompiledScene<Real>& scene) const {
    SceneView<Real> view = scene.view;
    const auto shift = [&](auto& pointer) {
      using Pointer = std::remove_reference_t<decltype(pointer)>;
      const std::byte* host = reinterpret_cast<const std::byte*>(pointer);
      if (pointer) pointer = reinterpret_cast<Pointer>(arena_.data() + (host - scene.arena.get()));
    };
#define ALHAZEN_ARRAY(type, name) shift(view.name);
    ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
    view.guide = guide_view_;
    return view;
  }

  /// Allocates the planes of the film one after the other, in the order of visit_planes.
  void upload_film(Film<Real>& film) {
    size_t bytes = 0;
    film.visit_planes([&](const void*, size_t size) { bytes += padded(size); });
    film_.reset();
    film_.reserve(bytes);
    std::byte* next = film_.data();
    film.visit_planes([&](const void* plane, size_t size) {
      if (size > 0) executor_.upload(next, plane, size);
      next += padded(size);
    });
    next = film_.data();
    const FilmView<Real> host = film.view();
    const size_t pixels = static_cast<size_t>(film.window().pixels());
    film_view_ = {};
#define ALHAZEN_PLANE(type, name)                    \
  if (host.name) {                                   \
    film_view_.name = reinterpret_cast<type*>(next); \
    next += padded(pixels * sizeof(type));           \
  }
    ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  }

  /// Uploads what the host has learned, and clears the sums of this device.
  void upload_guide(Guiding<Real>& guiding) {
    const GuideView<Real> host = guiding.view();
    guide_view_ = host;
    size_t bytes = 0;
    const auto place = [&](const auto* array, size_t count) {
      const size_t at = bytes;
      bytes += padded(count * sizeof(*array));
      return at;
    };
    const size_t cells = place(host.cells, host.cells_count), regions = place(host.regions, host.regions_count),
                 quads = place(host.quads, host.quads_count);
    guide_.reserve(bytes);
    const auto copy = [&](const auto*& pointer, const auto* array, size_t at, size_t count) {
      pointer = reinterpret_cast<decltype(array)>(guide_.data() + at);
      if (guide_generation_ != guiding.generation() || !has_guide_)
        executor_.upload(guide_.data() + at, array, count * sizeof(*array));
    };
    copy(guide_view_.cells, host.cells, cells, host.cells_count);
    copy(guide_view_.regions, host.regions, regions, host.regions_count);
    copy(guide_view_.quads, host.quads, quads, host.quads_count);
    has_guide_ = true;
    guide_generation_ = guiding.generation();
    const size_t light = padded(host.quads_count * 4 * sizeof(uint64_t)),
                 tallies = host.regions_count * sizeof(GuideTally);
    guide_sums_.reserve(light + tallies);
    executor_.clear(guide_sums_.data(), light + tallies);
    guide_view_.light = reinterpret_cast<uint64_t*>(guide_sums_.data());
    guide_view_.tallies = reinterpret_cast<GuideTally*>(guide_sums_.data() + light);
  }

  void download_guide(Guiding<Real>& guiding) {
    if (guiding.integrator() != IntegratorKind::guided_path) return;
    std::vector<uint64_t> light(size_t{guide_view_.quads_count} * 4);
    std::vector<GuideTally> tallies(guide_view_.regions_count);
    executor_.download(light.data(), guide_view_.light, light.size() * sizeof(uint64_t));
    executor_.download(tallies.data(), guide_view_.tallies, tallies.size() * sizeof(GuideTally));
    guiding.add(light.data(), tallies.data());
  }

  /// Downloads the rows of this device; if it has all of them, whole planes.
  void download(const RenderPass<Real>& pass) {
    const typename Executor::Range range("download the film");
    const FilmView<Real> host = pass.film.view();
    const size_t width = static_cast<size_t>(pass.film.window().width());
    const uint32_t height = static_cast<uint32_t>(pass.film.window().height());
    const uint32_t rows = device_rows_.rows_of(height);
    const auto copy = [&](auto* to, const auto* from) {
      if (!to || std::is_same_v<decltype(to), uint8_t*>) return;  // only the host finishes pixels
      if (device_rows_.devices == 1) return executor_.download(to, from, width * height * sizeof(*to));
      for (uint32_t row = 0; row < rows; row += DeviceRows::band) {
        const size_t first = device_rows_.window_row(row) * width;
        executor_.download(to + first, from + first, std::min(DeviceRows::band, rows - row) * width * sizeof(*to));
      }
    };
#define ALHAZEN_PLANE(type, name) copy(host.name, film_view_.name);
    ALHAZEN_FILM_PLANES(ALHAZEN_PLANE)
#undef ALHAZEN_PLANE
  }

  /// Number of pixels in the rows of a slice that are not finished.
  uint64_t unfinished(const Film<Real>& film, const Slice& slice) const {
    const PixelWindow& window = film.window();
    uint64_t count = 0;
    for (uint32_t row = slice.row; row < slice.row + slice.rows; ++row) {
      const int y = window.y0 + static_cast<int>(device_rows_.window_row(row));
      count += film.unfinished(window.x0, window.x1, y, y + 1);
    }
    return count;
  }

  void add_totals(ThreadStatistics& statistics) {
    Totals totals;
    executor_.download(&totals, totals_.data(), sizeof(Totals));
    statistics.samples += totals.samples;
    statistics.rays += totals.rays;
    statistics.shadow_rays += totals.shadow_rays;
    statistics.nonfinite_samples += totals.nonfinite;
  }

  static size_t padded(size_t bytes) { return (bytes + 255) / 256 * 256; }

  static CudaStrategy strategy_of(const RenderSettings& settings) {
    return static_cast<CudaStrategy>(settings.strategy);
  }

  // ---- launches --------------------------------------------------------------------------------------------------

  Launch<Real> launch_of(const RenderPass<Real>& pass) const {
    const PixelWindow& window = pass.film.window();
    return {device_scene(pass.scene),
            film_view_,
            totals_.data(),
            static_cast<uint32_t>(window.x0),
            static_cast<uint32_t>(window.y0),
            static_cast<uint32_t>(window.width()),
            device_rows_,
            {},
            pass.settings.sampler,
            sample_seed(pass.settings),
            pass.settings.max_segments};
  }

  /// Returns the number of items whose sums fill a third of the free memory, limited so that 32 bits can count them.
  uint64_t max_items(const RenderPass<Real>& pass) const {
    const CudaStrategy strategy = strategy_of(pass.settings);
    if (strategy == CudaStrategy::pixel || strategy == CudaStrategy::chunk) return uint64_t{1} << 40;
    const uint64_t memory = executor_.free_bytes() + sums_.size() * sizeof(BlockSum<Real>);
    return std::clamp<uint64_t>(memory / 3 / sizeof(BlockSum<Real>), 1, uint64_t{1} << 30);
  }

  bool run_slice(const RenderPass<Real>& pass, const Launch<Real>& launch) {
    switch (pass.integrator) {
      case IntegratorKind::path:
        return run_slice<IntegratorKind::path>(pass, launch);
      case IntegratorKind::guided_path:
        return run_slice<IntegratorKind::guided_path>(pass, launch);
      default:
        return run_slice<IntegratorKind::iterative>(pass, launch);
    }
  }

  /// Returns false if the render was stopped within the slice; nothing of the slice is in the film then.
  template <IntegratorKind kind>
  bool run_slice(const RenderPass<Real>& pass, const Launch<Real>& launch) {
    if constexpr (!Tracing::by_launch_of_pixels) {
      const CudaStrategy strategy = strategy_of(pass.settings);
      if (strategy == CudaStrategy::persistent || strategy == CudaStrategy::wavefront)
        return run_queue<kind>(pass, launch);
    }
    run_pixels<kind>(pass.settings, launch);
    return true;
  }

  template <IntegratorKind kind>
  bool run_queue(const RenderPass<Real>& pass, const Launch<Real>& launch) {
    const ItemGrid grid{launch.width, launch.slice.rows, launch.slice.blocks()};
    sums_.reserve(grid.count());
    if (strategy_of(pass.settings) == CudaStrategy::wavefront) {
      if (!run_wavefront<kind>(pass.control, launch, grid)) return false;
    } else {
      run_persistent<kind>(launch, grid);
    }
    executor_.launch(FoldKernel<Real>{launch, grid, sums_.data()}, {grid.width * grid.rows}, {default_block_threads});
    return true;
  }

  template <IntegratorKind kind>
  requires LaunchesKernel<Executor, PixelKernel<Tracing, kind, Real>>
  void run_pixels(const RenderSettings& settings, const Launch<Real>& launch) {
    const bool chunks = strategy_of(settings) == CudaStrategy::chunk;
    PixelKernel<Tracing, kind, Real> kernel{launch, chunks ? settings.chunk.x : 1, chunks ? settings.chunk.y : 1,
                                            nullptr};
    const Extent threads{kernel.chunk_width(), kernel.chunk_height()};
    sums_.reserve(static_cast<size_t>(threads.width) * threads.height);
    kernel.sums = sums_.data();
    executor_.launch(kernel, threads, {settings.block.x, settings.block.y});
  }

  template <IntegratorKind kind>
  requires LaunchesResidentKernel<Executor, PersistentKernel<Tracing, kind, Real>>
  void run_persistent(const Launch<Real>& launch, const ItemGrid& grid) {
    using Kernel = PersistentKernel<Tracing, kind, Real>;
    executor_.clear(counter_.data(), sizeof(uint32_t));
    const uint32_t threads = std::min(executor_.template resident_threads<Kernel>(default_block_threads), grid.count());
    executor_.launch(Kernel{launch, grid, counter_.data(), sums_.data()}, {threads}, {default_block_threads});
  }

  template <IntegratorKind kind>
  bool run_wavefront(const RenderControl& control, const Launch<Real>& launch, const ItemGrid& grid) {
    WavefrontStage<kind, Real> stage{launch, grid, make_slots<kind>(grid.count()), sums_.data(), 0};
    const Extent threads{stage.slots.count}, block{default_block_threads};
    const Extent padded_threads{stage.slots.count + material_queues * warp_lanes};
    executor_.launch(StartKernel<kind, Real>{stage}, threads, block);
    for (;;) {
      for (int round = 0; round < rounds_between_looks; ++round) {
        executor_.launch(GenerateKernel<kind, Real>{stage}, threads, block);
        executor_.launch(ResetKernel<kind, Real>{stage}, {1}, {1});
        executor_.launch(IntersectKernel<Tracing, kind, Real>{stage}, threads, block);
        executor_.launch(ShadeKernel<kind, Real>{stage}, padded_threads, block);
        if (samples_lights(kind)) executor_.launch(ShadowKernel<Tracing, kind, Real>{stage}, threads, block);
        stage.parity = 1 - stage.parity;
      }
      QueueCounts counts;
      executor_.download(&counts, stage.slots.counts, sizeof(counts));
      if (counts.rays[stage.parity] == 0 && counts.ended == 0) return true;
      // What was learned in a part of a slice could not be told from the rest.
      if (control.is_stopped() && kind != IntegratorKind::guided_path) return false;
    }
  }

  /// Allocates slots: as many as a third of the free memory holds, but no more than keep a large device busy and no
  /// more than there are items.
  template <IntegratorKind kind>
  Slots<kind, Real> make_slots(uint32_t items) {
    Slots<kind, Real> slots;
    slots.has_parts = film_view_.parts_light();
    size_t slot_bytes = 0;
    slots.visit_arrays([&](const auto* array, uint32_t elements) { slot_bytes += sizeof(*array) * elements; });
    constexpr uint64_t max_slots = uint64_t{1} << 21;
    const uint64_t memory = executor_.free_bytes() + slots_memory_.size();
    const uint64_t fit = std::max<uint64_t>(warp_lanes, memory / 3 / slot_bytes);
    slots.count = static_cast<uint32_t>(std::min<uint64_t>({items, fit, max_slots}));
    size_t bytes = padded(sizeof(QueueCounts));
    slots.visit_arrays(
        [&](const auto* array, uint32_t elements) { bytes += padded(sizeof(*array) * elements * slots.count); });
    slots_memory_.reserve(bytes);
    std::byte* next = slots_memory_.data();
    const auto place = [&](auto*& pointer, size_t count) {
      pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(next);
      next += padded(count * sizeof(*pointer));
    };
    place(slots.counts, 1);
    slots.visit_arrays(
        [&](auto*& array, uint32_t elements) { place(array, static_cast<size_t>(slots.count) * elements); });
    return slots;
  }

  /// Rounds between two checks of the queues, for which the host waits.
  static constexpr int rounds_between_looks = 8;

  Executor& executor_;
  DeviceRows device_rows_;
  const CompiledScene<Real>* scene_ = nullptr;
  const Film<Real>* host_film_ = nullptr;
  FilmView<Real> film_view_;
  Buffer<Executor, std::byte> arena_, film_;
  Buffer<Executor, Totals> totals_;
  Buffer<Executor, BlockSum<Real>> sums_;
  Buffer<Executor, std::byte> slots_memory_;
  Buffer<Executor, std::byte> guide_, guide_sums_;
  GuideView<Real> guide_view_;
  bool has_guide_ = false;
  uint64_t scene_generation_ = 0, guide_generation_ = 0, film_generation_ = 0;
  Buffer<Executor, uint32_t> counter_;
  uint64_t items_ = Executor::first_items;
};

}  // namespace alhazen::impl::cuda
