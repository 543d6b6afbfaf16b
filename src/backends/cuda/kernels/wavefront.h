#pragma once

// The strategy `wavefront`: one kernel per stage, with queues between them (Laine, Karras, Aila 2013, "Megakernels
// Considered Harmful"). A slot holds the state of one path. It takes one item after another, and the samples of an item
// in order. Queues hold indices of slots without gaps. The stages of a round are: generate, reset, intersect, shade
// (sorted by kind of material), shadow.

#include "backends/cuda/kernels/items.h"
#include "core/simd/soa.h"

namespace alhazen::impl::cuda {

/// Shading queues: one for each frequent kind of material, and one for all others.
inline constexpr uint32_t material_queues = frequent_material_kinds + 1;
inline constexpr uint32_t warp_lanes = 32;

/// The lengths of the queues.
struct QueueCounts {
  uint32_t next_item;  ///< of the slice's items
  uint32_t rays[2];    ///< of this round and of the next, in turn
  uint32_t ended, shadows;
  uint32_t materials[material_queues];
};

/// The sample that a slot is at.
template <class Real>
struct SlotSample {
  uint32_t item, taken;  ///< taken: number of samples of the item before this one
  Real filter_weight;

  using Fields = FieldList<&SlotSample::item, &SlotSample::taken, &SlotSample::filter_weight>;
};

/// A shadow ray that leaves the slot's hit, at the time of its path's ray, and the radiance that it may add.
template <class Real>
struct SlotShadowRay {
  Vec3<Real> origin, direction;
  Real t_max;
  Vec3<Real> radiance;

  using Fields =
      FieldList<&SlotShadowRay::origin, &SlotShadowRay::direction, &SlotShadowRay::t_max, &SlotShadowRay::radiance>;
};

/// The slots in structure-of-arrays form, and the queues of slots.
template <IntegratorKind kind, class Real>
struct Slots {
  SoAView<StateOf<kind, Real>> paths;
  SoAView<PathRecord<Real>> records;
  SoAView<SlotSample<Real>> samples;
  SoAView<Hit<Real>> hits;
  SoAView<SlotShadowRay<Real>> shadow_rays;
  TrailOf<kind, Real>* trails = nullptr;  ///< for guiding: one per slot
  PartedLight<Real>* parts = nullptr;     ///< one per slot if `has_parts`
  uint32_t* queues = nullptr;             ///< `count` entries each, one after another
  QueueCounts* counts = nullptr;
  uint32_t count = 0;
  bool has_parts = false;

  static constexpr uint32_t queue_count = 4 + material_queues;

  /// What the path of a slot keeps for guiding; `none` without guiding.
  ALHAZEN_HD TrailOf<kind, Real>& trail(uint32_t slot, TrailOf<kind, Real>& none) const {
    return kind == IntegratorKind::guided_path ? trails[slot] : none;
  }

  /// Gets the record of a slot.
  ALHAZEN_HD void get_record(uint32_t slot, PathRecord<Real>& record) const {
    records.get(slot, record);
    record.parts = has_parts ? parts + slot : nullptr;
  }

  ALHAZEN_HD uint32_t* ray_queue(uint32_t parity) const { return queue(parity); }
  ALHAZEN_HD uint32_t* ended_queue() const { return queue(2); }
  ALHAZEN_HD uint32_t* shadow_queue() const { return queue(3); }
  ALHAZEN_HD uint32_t* material_queue(uint32_t material) const { return queue(4 + material); }

  /// Calls visit(pointer, elements per slot) for each array.
  template <class Visit>
  void visit_arrays(const Visit& visit) {
    const auto one = [&](auto& array) { visit(array.elements, 1u); };
    paths.visit(one);
    records.visit(one);
    samples.visit(one);
    hits.visit(one);
    shadow_rays.visit(one);
    visit(trails, kind == IntegratorKind::guided_path ? 1u : 0u);
    visit(parts, has_parts ? 1u : 0u);
    visit(queues, queue_count);
  }

 private:
  ALHAZEN_HD uint32_t* queue(uint32_t index) const { return queues + static_cast<size_t>(index) * count; }
};

/// Appends `slot` to a queue.
template <QueueThread Thread>
ALHAZEN_HD void push(const Thread& thread, uint32_t* queue, uint32_t* length, uint32_t slot) {
  queue[thread.increment(length)] = slot;
}

/// The arguments of all stages.
template <IntegratorKind kind, class Real>
struct WavefrontStage {
  Launch<Real> launch;
  ItemGrid grid;
  Slots<kind, Real> slots;
  BlockSum<Real>* sums;  ///< one per item
  uint32_t parity;       ///< alternates between 0 and 1 from round to round

  ALHAZEN_HD AnySampler sampler_of(uint32_t slot) const {
    const SlotSample<Real> sample = slots.samples[slot];
    const Item item = item_at(grid, sample.item);
    return AnySampler(launch.sampler, launch.seed, launch.image_x(item.x), launch.image_y(item.row),
                      launch.slice.first + item.block * samples_per_block + sample.taken);
  }
};

/// Begins a slice: marks every slot as ended. One thread per slot.
template <IntegratorKind kind, class Real>
struct StartKernel {
  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const uint32_t slot = thread.index();
    if (slot == 0) *stage.slots.counts = QueueCounts{0, {0, 0}, stage.slots.count, 0, {}};
    if (slot >= stage.slots.count) return;
    stage.slots.ended_queue()[slot] = slot;
    element<&SlotSample<Real>::item>(stage.slots.samples, slot) = no_item;
  }

  static constexpr uint32_t no_item = 0xffffffffu;
};

/// Adds the samples that have ended to their items and begins the next ones. One thread per ended slot.
template <IntegratorKind kind, class Real>
struct GenerateKernel {
  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<kind, Real>& slots = stage.slots;
    const Launch<Real>& launch = stage.launch;
    if (thread.index() >= slots.counts->ended) return;
    const uint32_t slot = slots.ended_queue()[thread.index()];
    const uint32_t ended_item = element<&SlotSample<Real>::item>(slots.samples, slot);
    const bool has_item = ended_item != StartKernel<kind, Real>::no_item;
    SlotSample<Real> sample{ended_item, 0, 0};
    Item item{};
    if (has_item) {
      sample = slots.samples[slot];
      close_sample(slot, sample);
      ++sample.taken;
      item = item_at(stage.grid, sample.item);
    }
    if (!has_item || sample.taken == launch.samples_in_block(item.block)) {
      if (!claim_item(thread, launch, stage.grid, &slots.counts->next_item, sample.item, item)) return;
      stage.sums[sample.item].begin(launch.film.needs_layer_sums());
      sample.taken = 0;
    }
    slots.samples.set(slot, sample);
    const CameraSample<Real> camera =
        sample_camera(launch.scene, stage.sampler_of(slot), launch.image_x(item.x), launch.image_y(item.row));
    StateOf<kind, Real> path;
    path.ray = camera.ray;
    slots.paths.set(slot, path);
    slots.records.set(slot, {});
    if (slots.has_parts) slots.parts[slot] = {};
    if constexpr (kind == IntegratorKind::guided_path) slots.trails[slot].begin();
    element<&SlotSample<Real>::filter_weight>(slots.samples, slot) = camera.filter_weight;
    push(thread, slots.ray_queue(stage.parity), &slots.counts->rays[stage.parity], slot);
  }

 private:
  ALHAZEN_HD void close_sample(uint32_t slot, const SlotSample<Real>& sample) const {
    PathRecord<Real> record;
    stage.slots.get_record(slot, record);
    if constexpr (kind == IntegratorKind::guided_path)
      learn_from_path(stage.launch.scene, stage.slots.trails[slot], record.radiance);
    record.expose(stage.launch.scene.exposure);
    stage.sums[sample.item].add_path(record, sample.filter_weight);
  }
};

/// Empties the queues that this round fills, after `generate` has read them. One thread.
template <IntegratorKind kind, class Real>
struct ResetKernel {
  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    if (thread.index() != 0) return;
    QueueCounts& counts = *stage.slots.counts;
    counts.ended = counts.shadows = counts.rays[1 - stage.parity] = 0;
    for (uint32_t& length : counts.materials) length = 0;
  }
};

/// Traces the rays and queues the slots that hit something by their kind of material. One thread per queue entry.
template <RayTracing Tracing, IntegratorKind kind, class Real>
struct IntersectKernel {
  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<kind, Real>& slots = stage.slots;
    if (thread.index() >= slots.counts->rays[stage.parity]) return;
    const uint32_t slot = slots.ray_queue(stage.parity)[thread.index()];
    ++element<&PathRecord<Real>::segments>(slots.records, slot);
    if constexpr (kind == IntegratorKind::guided_path)
      slots.trails[slot].start_segment(luminance(slots.records[slot].radiance));
    Hit<Real> hit;
    const auto intersector = Tracing::intersector(stage.launch.scene, thread.stacks());
    if (intersector.closest_hit(slots.paths[slot].ray, infinity<Real>, hit)) {
      slots.hits.set(slot, hit);
      const uint32_t own_kind = static_cast<uint32_t>(material_kind(hit.primitive));
      const uint32_t material = own_kind < material_queues ? own_kind : material_queues - 1;
      push(thread, slots.material_queue(material), &slots.counts->materials[material], slot);
      return;
    }
    SumRecord<Real> record(&stage.sums[slots.samples[slot].item], stage.launch.film);
    slots.get_record(slot, record);
    add_infinite_lights(stage.launch.scene, slots.paths[slot], record);
    slots.records.set(slot, record);
    push(thread, slots.ended_queue(), &slots.counts->ended, slot);
  }

 private:
  ALHAZEN_HD MaterialKind material_kind(PrimitiveId primitive) const {
    const SceneView<Real>& scene = stage.launch.scene;
    return scene.materials[scene.surfaces[surface_of(scene, primitive)].material].kind;
  }
};

/// Adds emission, samples lights and scatters. The threads are assigned to the shading queues one after another, and
/// each queue begins with a new warp, so the launch needs one more warp per queue than the slots fill.
template <IntegratorKind kind, class Real>
struct ShadeKernel {
  /// In float, three fit almost without spilling; without this bound the compiler uses registers for two.
  static constexpr uint32_t resident_blocks = sizeof(Real) == sizeof(float) ? 3 : 1;

  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<kind, Real>& slots = stage.slots;
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
    const Slots<kind, Real>& slots = stage.slots;
    StateOf<kind, Real> path = slots.paths[slot];
    SumRecord<Real> record(&stage.sums[slots.samples[slot].item], stage.launch.film);
    slots.get_record(slot, record);
    TrailOf<kind, Real> none;
    const bool goes_on = shade(
        stage.launch.scene, stage.sampler_of(slot), stage.launch.max_segments, slots.hits[slot], path, record,
        [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
          queue_shadow(thread, slot, shadow, limited(stage.launch.scene, radiance, path.vertex >= 1));
        },
        slots.trail(slot, none));
    slots.paths.set(slot, path);
    slots.records.set(slot, record);
    if (goes_on)
      push(thread, slots.ray_queue(1 - stage.parity), &slots.counts->rays[1 - stage.parity], slot);
    else
      push(thread, slots.ended_queue(), &slots.counts->ended, slot);
  }

  template <QueueThread Thread>
  ALHAZEN_HD void queue_shadow(const Thread& thread, uint32_t slot, const ShadowRay<Real>& shadow,
                               const Vec3<Real>& radiance) const {
    const Slots<kind, Real>& slots = stage.slots;
    slots.shadow_rays.set(slot, {shadow.ray.origin, shadow.ray.direction, shadow.t_max, radiance});
    push(thread, slots.shadow_queue(), &slots.counts->shadows, slot);
  }
};

/// Traces shadow rays and adds the light of those that are not occluded. One thread per queue entry.
template <RayTracing Tracing, IntegratorKind kind, class Real>
struct ShadowKernel {
  WavefrontStage<kind, Real> stage;

  template <QueueThread Thread>
  ALHAZEN_HD void operator()(const Thread& thread) const {
    const Slots<kind, Real>& slots = stage.slots;
    if (thread.index() >= slots.counts->shadows) return;
    const uint32_t slot = slots.shadow_queue()[thread.index()];
    const SlotShadowRay<Real> stored = slots.shadow_rays[slot];
    const Hit<Real> hit = slots.hits[slot];
    const ShadowRay<Real> shadow{
        {stored.origin, stored.direction, slots.paths[slot].ray.time, hit.primitive, hit.instance}, stored.t_max};
    const SceneView<Real>& scene = stage.launch.scene;
    const Real visibility = visibility_of(scene, Tracing::intersector(scene, thread.stacks()), shadow);
    if (!(visibility > 0)) return;
    PathRecord<Real> record;
    slots.get_record(slot, record);
    record.add_sampled(stored.radiance * visibility);
    slots.records.set(slot, record);
  }
};

}  // namespace alhazen::impl::cuda
