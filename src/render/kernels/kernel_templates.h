#pragma once

// The definition of the sample kernels, for the files that instantiate it.

#include "core/bvh/bvh8/intersector.h"
#include "core/film/block_sum.h"
#include "core/integrators/batch.h"
#include "core/sampling/any_sampler.h"
#include "render/kernels/request.h"

namespace ALHAZEN_CORE {

/// Takes one sample after the other, for recursive integrators and for counters.
template <IntegratorKind kind, class Sampler, class Real, RayIntersector<Real> Intersector>
requires SamplerOf<Sampler, Real>
void take_blocks_singly(const KernelRequest& request, const SceneView<Real>& scene, const Intersector& intersector,
                        BlockSum<Real>* sums) {
  PartedLight<Real>* const parts = static_cast<PartedLight<Real>*>(request.parts);
  for (uint32_t b = 0; b < request.block_count; ++b) {
    const BlockRequest& block = request.blocks[b];
    for (uint32_t i = 0; i < block.count; ++i) {
      if (parts) *parts = {};
      const Sampler sampler({request.seed, request.screen_order}, block.x, block.y, block.first + i);
      const CameraSample<Real> camera = sample_camera(scene, sampler, block.x, block.y);
      sums[b].add(integrate<kind>(scene, intersector, sampler, camera.ray, request.max_segments,
                                  {request.wants_first_hit, request.wants_first_point}, parts),
                  camera.filter_weight);
    }
  }
}

template <IntegratorKind kind, class Sampler, class Real, BatchIntersector<Real> Intersector>
requires SamplerOf<Sampler, Real>
void take_blocks_together(const KernelRequest& request, const SceneView<Real>& scene, const Intersector& intersector,
                          BlockSum<Real>* sums) {
  // Every block has space for samples_per_block records, whether or not it uses them all.
  // Nothing is read that `end` below has not set, and initialising it all would take longer.
  alignas(SampleRecord<Real>) unsigned char
      storage[max_blocks_per_request * samples_per_block * sizeof(SampleRecord<Real>)];
  SampleRecord<Real>* const records = reinterpret_cast<SampleRecord<Real>*>(storage);
  Real weights[max_blocks_per_request * samples_per_block];
  uint16_t slots[max_blocks_per_request * samples_per_block];
  uint32_t count = 0;
  for (uint32_t b = 0; b < request.block_count; ++b)
    for (uint32_t i = 0; i < request.blocks[b].count; ++i)
      slots[count++] = static_cast<uint16_t>(b * samples_per_block + i);
  PartedLight<Real>* const parts = static_cast<PartedLight<Real>*>(request.parts);
  for (uint32_t i = 0; parts && i < count; ++i) parts[i] = {};
  integrate_batch<kind, Sampler>(
      scene, intersector, {request.seed, request.screen_order}, request.max_segments,
      {request.wants_first_hit, request.wants_first_point}, parts, count,
      [&](uint32_t sample) -> PixelSample {
        const uint32_t slot = slots[sample];
        const BlockRequest& block = request.blocks[slot / samples_per_block];
        return {block.x, block.y, block.first + slot % samples_per_block};
      },
      [&](uint32_t sample, const SampleRecord<Real>& record, Real filter_weight) {
        // Member by member: reading the whole record would wait for the path's last stores.
        SampleRecord<Real>& kept = records[slots[sample]];
        kept.radiance = record.radiance;
        kept.parts = record.parts;
        kept.expose(scene.exposure);
        kept.transparency = record.transparency;
        kept.segments = record.segments;
        kept.shadow_rays = record.shadow_rays;
        kept.has_hit = record.has_hit;
        if (record.has_hit) kept.first = record.first;
        kept.has_point = record.has_point;
        if (record.has_point) kept.first_point = record.first_point;
        weights[slots[sample]] = filter_weight;
      });
  // Interleaves some blocks: the next sample of a block depends on the one before it.
  constexpr uint32_t interleaved = 16;
  for (uint32_t first = 0; first < request.block_count; first += interleaved)
    for (uint32_t i = 0; i < samples_per_block; ++i)
      for (uint32_t b = first; b < first + interleaved && b < request.block_count; ++b) {
        const uint32_t slot = b * samples_per_block + i;
        if (i < request.blocks[b].count) sums[b].add(records[slot], weights[slot]);
      }
}

/// Constructs the intersector from the scene and, if it names the type of one, the tracer.
template <class Intersector, class Real>
requires RayIntersector<Intersector, Real> Intersector make_intersector(const SceneView<Real>& scene,
                                                                        [[maybe_unused]] const ExternalTracer* tracer) {
  if constexpr (requires { typename Intersector::Tracer; })
    return Intersector(scene, *static_cast<const typename Intersector::Tracer*>(tracer));
  else
    return Intersector(scene);
}

template <IntegratorKind kind, class Sampler, class Intersector, class Real>
requires BatchIntersector<Intersector, Real> && SamplerOf<Sampler, Real>
void take_blocks(const KernelRequest& request) {
  const SceneView<Real>& scene = *static_cast<const SceneView<Real>*>(request.scene);
  const Intersector intersector = make_intersector<Intersector>(scene, request.tracer);
  BlockSum<Real>* const sums = static_cast<BlockSum<Real>*>(request.sums);
  for (uint32_t b = 0; b < request.block_count; ++b)
    sums[b].begin(request.parts != nullptr || request.wants_first_point);
  // Samples are counted where one is taken after the other, which gives the same bits.
  if constexpr ((samples_lights(kind) || kind == IntegratorKind::iterative) && !counts_samples)
    take_blocks_together<kind, Sampler>(request, scene, intersector, sums);
  else
    take_blocks_singly<kind, Sampler>(request, scene, intersector, sums);
}

template <class Sampler, class Intersector, class Real>
RawKernel select_by_integrator(IntegratorKind integrator) {
  switch (integrator) {
    case IntegratorKind::branching:
      return take_blocks<IntegratorKind::branching, Sampler, Intersector, Real>;
    case IntegratorKind::recursive:
      return take_blocks<IntegratorKind::recursive, Sampler, Intersector, Real>;
    case IntegratorKind::iterative:
      return take_blocks<IntegratorKind::iterative, Sampler, Intersector, Real>;
    case IntegratorKind::guided_path:
      return take_blocks<IntegratorKind::guided_path, Sampler, Intersector, Real>;
    case IntegratorKind::path:
      break;
  }
  return take_blocks<IntegratorKind::path, Sampler, Intersector, Real>;
}

template <class Intersector, class Real>
RawKernel select_kernel(IntegratorKind integrator, SamplerType sampler) {
  return sampler == SamplerType::independent ? select_by_integrator<IndependentSampler, Intersector, Real>(integrator)
                                             : select_by_integrator<SobolSampler, Intersector, Real>(integrator);
}

}  // namespace ALHAZEN_CORE
