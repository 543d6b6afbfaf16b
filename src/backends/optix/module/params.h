#pragma once

// What host and device programs agree on: names, payloads, the layout of the shader binding table, launch parameters.

#include <optix_types.h>

#include "backends/cuda/kernels/pixel.h"

namespace alhazen::optix {

/// Ray queries by optixTrace. What a thread offers as its stacks says which intersector that is: on the device
/// OptixIntersector (programs.cu).
struct OptixTracing {
  static constexpr bool by_launch_of_pixels = true;

  template <class Stacks>
  ALHAZEN_HD static typename Stacks::Intersector intersector(const SceneView<float>& scene, const Stacks& stacks) {
    return typename Stacks::Intersector(scene, stacks);
  }
};

/// The kernel that ray generation runs: a thread a pixel, taking all samples of the slice.
template <IntegratorKind kind>
using OptixKernel = cuda::PixelKernel<OptixTracing, kind, float>;

struct OptixParams {
  cuda::Launch<float> launch;
  BlockSum<float>* sums;  ///< one a thread
  OptixTraversableHandle traversable;
  uint32_t sbt_offset;  ///< of rays: 0 where instances have offsets of their own, else the only kind of primitive
};

/// Closest hits. Words of the payload: t, b1, b2, PrimitiveId, instance.
inline constexpr unsigned closest_words = 5;
/// Identifiers of OptiX's instances: below this the kinds of primitives of the world, from it on ours.
inline constexpr unsigned first_instance_id = primitive_kinds;
/// Occlusion. The payload is one word: 1, or 0 if the ray missed everything.
inline constexpr unsigned occlusion_words = 1;

// Records of the shader binding table, each no more than its header.
enum RaygenRecord : unsigned { raygen_path, raygen_iterative };
enum MissRecord : unsigned { miss_closest, miss_occlusion };
inline constexpr unsigned raygen_records = 2, miss_records = 2;
inline constexpr unsigned hit_records = primitive_kinds;  ///< by PrimitiveKind

inline constexpr const char* params_name = "params";
inline constexpr const char* raygen_names[raygen_records] = {"__raygen__path", "__raygen__iterative"};
inline constexpr const char* miss_occlusion_name = "__miss__occlusion";
inline constexpr const char* closest_hit_names[hit_records] = {
#define ALHAZEN_NAME(X, kind, Record, records, Block, blocks) "__closesthit__" #kind,
    ALHAZEN_PRIMITIVES(ALHAZEN_NAME, )
#undef ALHAZEN_NAME
};

}  // namespace alhazen::optix
