#pragma once

// Persistent threads, which run until the queue is empty (Aila and Laine 2009, "Understanding the Efficiency of Ray
// Traversal on GPUs"). A lane whose path has ended immediately starts the next sample while the other lanes of its warp
// continue. All lanes reconverge between two segments.

#include "backends/cuda/kernels/items.h"

namespace alhazen::impl::cuda {

template <RayTracing Tracing, IntegratorKind kind, class Real>
struct PersistentKernel {
  Launch<Real> launch;
  ItemGrid grid;
  uint32_t* next_item;   ///< initially 0
  BlockSum<Real>* sums;  ///< one per item

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const auto intersector = Tracing::intersector(launch.scene, thread.stacks());
    AnySampler sampler(launch.sampler, 0, 0, 0, 0);
    SumRecord<Real> record(nullptr, launch.film);
    PartedLight<Real> parts;
    StateOf<kind, Real> path;
    TrailOf<kind, Real> trail;
    Real filter_weight = 0;
    Item item{};
    uint32_t taken = 0, to_take = 0;  // samples of the item
    bool is_under_way = false;
    for (;;) {
      if (!is_under_way) {
        if (taken == to_take) {
          uint32_t index;
          if (!claim_item(thread, launch, grid, next_item, index, item)) return;
          sums[index].begin(launch.film.needs_layer_sums());
          record.sum = &sums[index];
          taken = 0;
          to_take = launch.samples_in_block(item.block);
        }
        const uint32_t px = launch.image_x(item.x), py = launch.image_y(item.row);
        sampler = AnySampler(launch.sampler, launch.seed, px, py,
                             launch.slice.first + item.block * samples_per_block + taken);
        const CameraSample<Real> camera = sample_camera(launch.scene, sampler, px, py);
        filter_weight = camera.filter_weight;
        path = {};
        path.ray = camera.ray;
        trail.begin();
        static_cast<PathRecord<Real>&>(record) = {};
        if (launch.film.parts_light()) {
          parts = {};
          record.parts = &parts;
        }
      }
      is_under_way = take_segment(launch.scene, intersector, sampler, launch.max_segments, path, record, trail);
      if (is_under_way) continue;
      learn_from_path(launch.scene, trail, record.radiance);
      record.expose(launch.scene.exposure);
      record.sum->add_path(record, filter_weight);
      ++taken;
    }
  }
};

}  // namespace alhazen::impl::cuda
