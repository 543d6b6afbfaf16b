#pragma once

// Paths in queues, a kernel a stage (Laine, Karras, Aila 2013, "Megakernels Considered Harmful"). A slot is the place
// of one path; it takes an item after another, and the samples of an item one after another. Queues hold slots, and are
// filled without gaps. One round is: generate, reset, intersect, shade (sorted by kind of material), shadow.

#include "backends/cuda/kernels/items.h"

namespace alhazen::cuda {

/// Queues of shading: one each for the kinds of material that are frequent, one for the others.
inline constexpr uint32_t material_queues = frequent_material_kinds + 1;
static_assert(material_queues == 4, "as many queues as the list of arrays below has");
inline constexpr uint32_t warp_lanes = 32;

// clang-format does not know what separates these.
// clang-format off
/// Every array of the slots, once: ARRAY(element type, name). Structure of arrays, one element a slot.
#define ALHAZEN_SLOT_ARRAYS(ARRAY)                                                                                     \
  ARRAY(Real, origin_x) ARRAY(Real, origin_y) ARRAY(Real, origin_z)                                                    \
  ARRAY(Real, direction_x) ARRAY(Real, direction_y) ARRAY(Real, direction_z) ARRAY(Real, time)                         \
  ARRAY(Real, throughput_x) ARRAY(Real, throughput_y) ARRAY(Real, throughput_z)                                        \
  ARRAY(Real, bsdf_pdf) ARRAY(Real, eta_scale) ARRAY(uint32_t, vertex) ARRAY(Real, travelled)                          \
  ARRAY(Real, light_side_x) ARRAY(Real, light_side_y) ARRAY(Real, light_side_z)                                        \
  ARRAY(Real, radiance_x) ARRAY(Real, radiance_y) ARRAY(Real, radiance_z)                                              \
  ARRAY(uint32_t, segments) ARRAY(uint32_t, shadow_rays)                                                               \
  ARRAY(Real, filter_weight) ARRAY(uint32_t, item) ARRAY(uint32_t, taken)                                              \
  ARRAY(Real, hit_t) ARRAY(Real, hit_b1) ARRAY(Real, hit_b2)                                                           \
  ARRAY(PrimitiveId, hit_primitive) ARRAY(uint32_t, hit_instance)                                                      \
  ARRAY(Real, shadow_origin_x) ARRAY(Real, shadow_origin_y) ARRAY(Real, shadow_origin_z)                               \
  ARRAY(Real, shadow_direction_x) ARRAY(Real, shadow_direction_y) ARRAY(Real, shadow_direction_z)                      \
  ARRAY(Real, shadow_t_max)                                                                                            \
  ARRAY(Real, light_x) ARRAY(Real, light_y) ARRAY(Real, light_z)                                                       \
  ARRAY(uint32_t, ray_queue_0) ARRAY(uint32_t, ray_queue_1) ARRAY(uint32_t, ended_queue) ARRAY(uint32_t, shadow_queue) \
  ARRAY(uint32_t, material_queue_0) ARRAY(uint32_t, material_queue_1) ARRAY(uint32_t, material_queue_2)                \
  ARRAY(uint32_t, material_queue_3)
// clang-format on

/// The lengths of the queues.
struct QueueCounts {
  uint32_t next_item;  ///< of the slice's items
  uint32_t rays[2];    ///< of this round and of the next, in turn
  uint32_t ended, shadows;
  uint32_t materials[material_queues];
};

template <class Real>
struct Slots {
#define ALHAZEN_ARRAY(type, name) type* name = nullptr;
  ALHAZEN_SLOT_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  QueueCounts* counts = nullptr;
  uint32_t count = 0;

  ALHAZEN_HD uint32_t* ray_queue(uint32_t parity) const { return parity == 0 ? ray_queue_0 : ray_queue_1; }
  ALHAZEN_HD uint32_t* material_queue(uint32_t kind) const {
    return kind == 0   ? material_queue_0
           : kind == 1 ? material_queue_1
           : kind == 2 ? material_queue_2
                       : material_queue_3;
  }

  ALHAZEN_HD Ray<Real> ray(uint32_t s) const {
    return {{origin_x[s], origin_y[s], origin_z[s]},
            {direction_x[s], direction_y[s], direction_z[s]},
            time[s],
            hit_primitive[s],
            hit_instance[s]};
  }
  /// A ray leaves what was hit last in its slot: `hit_primitive` and `hit_instance` say that until it hits something.
  ALHAZEN_HD void set_ray(uint32_t s, const Ray<Real>& ray) const {
    origin_x[s] = ray.origin.x, origin_y[s] = ray.origin.y, origin_z[s] = ray.origin.z;
    direction_x[s] = ray.direction.x, direction_y[s] = ray.direction.y, direction_z[s] = ray.direction.z;
    time[s] = ray.time;
    hit_primitive[s] = ray.left;
    hit_instance[s] = ray.left_instance;
  }
  ALHAZEN_HD void load(uint32_t s, IterativeState<Real>& path) const {
    path.ray = ray(s);
    path.throughput = {throughput_x[s], throughput_y[s], throughput_z[s]};
    path.vertex = vertex[s];
    path.travelled = travelled[s];
  }
  ALHAZEN_HD void store(uint32_t s, const IterativeState<Real>& path) const {
    set_ray(s, path.ray);
    throughput_x[s] = path.throughput.x, throughput_y[s] = path.throughput.y, throughput_z[s] = path.throughput.z;
    vertex[s] = path.vertex;
    travelled[s] = path.travelled;
  }
  ALHAZEN_HD void load(uint32_t s, PathState<Real>& path) const {
    path.ray = ray(s);
    path.throughput = {throughput_x[s], throughput_y[s], throughput_z[s]};
    path.vertex = vertex[s] >> 1;
    path.is_specular = vertex[s] & 1;
    path.bsdf_pdf = bsdf_pdf[s];
    path.eta_scale = eta_scale[s];
    path.light_side = {light_side_x[s], light_side_y[s], light_side_z[s]};
    path.travelled = travelled[s];
  }
  ALHAZEN_HD void store(uint32_t s, const PathState<Real>& path) const {
    set_ray(s, path.ray);
    throughput_x[s] = path.throughput.x, throughput_y[s] = path.throughput.y, throughput_z[s] = path.throughput.z;
    vertex[s] = path.vertex << 1 | (path.is_specular ? 1u : 0u);
    bsdf_pdf[s] = path.bsdf_pdf;
    eta_scale[s] = path.eta_scale;
    light_side_x[s] = path.light_side.x, light_side_y[s] = path.light_side.y, light_side_z[s] = path.light_side.z;
    travelled[s] = path.travelled;
  }
  ALHAZEN_HD void load(uint32_t s, PathRecord<Real>& record) const {
    record.radiance = {radiance_x[s], radiance_y[s], radiance_z[s]};
    record.segments = segments[s];
    record.shadow_rays = shadow_rays[s];
  }
  ALHAZEN_HD void store(uint32_t s, const PathRecord<Real>& record) const {
    radiance_x[s] = record.radiance.x, radiance_y[s] = record.radiance.y, radiance_z[s] = record.radiance.z;
    segments[s] = record.segments;
    shadow_rays[s] = record.shadow_rays;
  }
};

/// Appends `slot` to a queue.
template <QueueThread Thread>
ALHAZEN_HD void push(const Thread& thread, uint32_t* queue, uint32_t* length, uint32_t slot) {
  queue[thread.increment(length)] = slot;
}

/// What the stages have in common.
template <class Real>
struct WavefrontStage {
  Launch<Real> launch;
  ItemGrid grid;
  Slots<Real> slots;
  BlockSum<Real>* sums;  ///< one an item
  uint32_t parity;       ///< 0 and 1 in turn, round after round

  ALHAZEN_HD AnySampler sampler_of(uint32_t slot) const {
    const Item item = item_at(grid, slots.item[slot]);
    return AnySampler(launch.sampler, launch.seed, launch.image_x(item.x), launch.image_y(item.row),
                      launch.slice.first + item.block * samples_per_block + slots.taken[slot]);
  }
};

/// Every slot has ended, with nothing taken: where a slice begins. A thread a slot.
template <class Real>
struct StartKernel {
  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const uint32_t slot = thread.index();
    if (slot == 0) *stage.slots.counts = QueueCounts{0, {0, 0}, stage.slots.count, 0, {}};
    if (slot >= stage.slots.count) return;
    stage.slots.ended_queue[slot] = slot;
    stage.slots.item[slot] = no_item;
  }

  static constexpr uint32_t no_item = 0xffffffffu;
};

/// Closes the samples that have ended and begins the next ones. A thread an entry of the queue of ended slots.
template <IntegratorKind kind, class Real>
struct GenerateKernel {
  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<Real>& slots = stage.slots;
    const Launch<Real>& launch = stage.launch;
    if (thread.index() >= slots.counts->ended) return;
    const uint32_t slot = slots.ended_queue[thread.index()];
    uint32_t index = slots.item[slot];
    uint32_t taken = 0;
    if (index != StartKernel<Real>::no_item) {
      close_sample(slot, index);
      taken = slots.taken[slot] + 1;
    }
    Item item{};
    if (index != StartKernel<Real>::no_item) item = item_at(stage.grid, index);
    if (index == StartKernel<Real>::no_item || taken == launch.samples_in_block(item.block)) {
      if (!claim_item(thread, launch, stage.grid, &slots.counts->next_item, index, item)) return;
      stage.sums[index] = {};
      slots.item[slot] = index;
      taken = 0;
    }
    slots.taken[slot] = taken;
    const CameraSample<Real> camera =
        sample_camera(launch.scene, stage.sampler_of(slot), launch.image_x(item.x), launch.image_y(item.row));
    StateOf<kind, Real> path;
    path.ray = camera.ray;
    slots.store(slot, path);
    slots.store(slot, PathRecord<Real>{});
    slots.filter_weight[slot] = camera.filter_weight;
    push(thread, slots.ray_queue(stage.parity), &slots.counts->rays[stage.parity], slot);
  }

 private:
  ALHAZEN_HD void close_sample(uint32_t slot, uint32_t item) const {
    PathRecord<Real> record;
    stage.slots.load(slot, record);
    record.radiance *= stage.launch.scene.exposure;
    stage.sums[item].add_path(record, stage.slots.filter_weight[slot]);
  }
};

/// Empties the queues that this round fills, once `generate` has read the last of them. One thread.
template <class Real>
struct ResetKernel {
  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    if (thread.index() != 0) return;
    QueueCounts& counts = *stage.slots.counts;
    counts.ended = counts.shadows = counts.rays[1 - stage.parity] = 0;
    for (uint32_t& length : counts.materials) length = 0;
  }
};

/// Traces the rays, and queues those that hit something by the kind of its material. One thread per queue entry.
template <class Tracing, IntegratorKind kind, class Real>
struct IntersectKernel {
  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<Real>& slots = stage.slots;
    if (thread.index() >= slots.counts->rays[stage.parity]) return;
    const uint32_t slot = slots.ray_queue(stage.parity)[thread.index()];
    ++slots.segments[slot];
    Hit<Real> hit;
    if (Tracing::intersector(stage.launch.scene, thread.stacks()).closest_hit(slots.ray(slot), infinity<Real>, hit)) {
      slots.hit_t[slot] = hit.t;
      slots.hit_b1[slot] = hit.b1;
      slots.hit_b2[slot] = hit.b2;
      slots.hit_primitive[slot] = hit.primitive;
      slots.hit_instance[slot] = hit.instance;
      const uint32_t own_kind = static_cast<uint32_t>(material_kind(hit.primitive));
      const uint32_t material = own_kind < material_queues ? own_kind : material_queues - 1;
      push(thread, slots.material_queue(material), &slots.counts->materials[material], slot);
      return;
    }
    StateOf<kind, Real> path;
    PathRecord<Real> record;
    slots.load(slot, path);
    slots.load(slot, record);
    add_infinite_lights(stage.launch.scene, path, record);
    slots.store(slot, record);
    push(thread, slots.ended_queue, &slots.counts->ended, slot);
  }

 private:
  ALHAZEN_HD MaterialKind material_kind(PrimitiveId primitive) const {
    const SceneView<Real>& scene = stage.launch.scene;
    return scene.materials[scene.surfaces[surface_of(scene, primitive)].material].kind;
  }
};

/// Gathers, samples lights, scatters. Threads go through the queues of the kinds of material one after another, each
/// beginning with a warp of its own: at least as many warps more than slots as there are queues.
template <IntegratorKind kind, class Real>
struct ShadeKernel {
  /// In float three fit without spilling, where the compiler left alone makes two of them.
  static constexpr uint32_t resident_blocks = sizeof(Real) == sizeof(float) ? 3 : 1;

  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<Real>& slots = stage.slots;
    uint32_t place = thread.index();
    for (uint32_t material = 0; material < material_queues; ++material) {
      const uint32_t length = slots.counts->materials[material];
      if (place < length) return shade_slot(thread, slots.material_queue(material)[place]);
      const uint32_t padded = (length + warp_lanes - 1) / warp_lanes * warp_lanes;
      if (place < padded) return;
      place -= padded;
    }
  }

 private:
  template <QueueThread Thread>
  ALHAZEN_HD void shade_slot(const Thread& thread, uint32_t slot) const {
    const Slots<Real>& slots = stage.slots;
    const Hit<Real> hit{slots.hit_t[slot], slots.hit_b1[slot], slots.hit_b2[slot], slots.hit_primitive[slot],
                        slots.hit_instance[slot]};
    StateOf<kind, Real> path;
    SumRecord<Real> record(&stage.sums[slots.item[slot]], stage.launch.film);
    slots.load(slot, path);
    slots.load(slot, static_cast<PathRecord<Real>&>(record));
    const bool goes_on = shade(stage.launch.scene, stage.sampler_of(slot), stage.launch.max_segments, hit, path, record,
                               [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
                                 queue_shadow(thread, slot, shadow, radiance);
                               });
    slots.store(slot, path);
    slots.store(slot, record);
    if (goes_on)
      push(thread, slots.ray_queue(1 - stage.parity), &slots.counts->rays[1 - stage.parity], slot);
    else
      push(thread, slots.ended_queue, &slots.counts->ended, slot);
  }

  template <QueueThread Thread>
  ALHAZEN_HD void queue_shadow(const Thread& thread, uint32_t slot, const ShadowRay<Real>& shadow,
                               const Vec3<Real>& radiance) const {
    const Slots<Real>& slots = stage.slots;
    slots.shadow_origin_x[slot] = shadow.ray.origin.x;
    slots.shadow_origin_y[slot] = shadow.ray.origin.y;
    slots.shadow_origin_z[slot] = shadow.ray.origin.z;
    slots.shadow_direction_x[slot] = shadow.ray.direction.x;
    slots.shadow_direction_y[slot] = shadow.ray.direction.y;
    slots.shadow_direction_z[slot] = shadow.ray.direction.z;
    slots.shadow_t_max[slot] = shadow.t_max;
    slots.light_x[slot] = radiance.x;
    slots.light_y[slot] = radiance.y;
    slots.light_z[slot] = radiance.z;
    push(thread, slots.shadow_queue, &slots.counts->shadows, slot);
  }
};

/// Traces shadow rays, and adds the light of those that are not occluded. One thread per queue entry.
template <class Tracing, class Real>
struct ShadowKernel {
  WavefrontStage<Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<Real>& slots = stage.slots;
    if (thread.index() >= slots.counts->shadows) return;
    const uint32_t s = slots.shadow_queue[thread.index()];
    const ShadowRay<Real> shadow{
        {{slots.shadow_origin_x[s], slots.shadow_origin_y[s], slots.shadow_origin_z[s]},
         {slots.shadow_direction_x[s], slots.shadow_direction_y[s], slots.shadow_direction_z[s]},
         slots.time[s],
         slots.hit_primitive[s],
         slots.hit_instance[s]},
        slots.shadow_t_max[s]};
    const SceneView<Real>& scene = stage.launch.scene;
    const Real visibility = visibility_of(scene, Tracing::intersector(scene, thread.stacks()), shadow);
    if (!(visibility > 0)) return;
    slots.radiance_x[s] += slots.light_x[s] * visibility;
    slots.radiance_y[s] += slots.light_y[s] * visibility;
    slots.radiance_z[s] += slots.light_z[s] * visibility;
  }
};

}  // namespace alhazen::cuda
