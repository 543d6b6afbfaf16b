#pragma once

// Definitions that host code and device programs share: names, payloads, the layout of the shader binding table, launch
// parameters.

#include <optix_types.h>

#include "backends/cuda/kernels/pixel.h"

namespace alhazen::impl::optix {

/// Traces rays with the intersector that belongs to the stacks of the thread. On the device this is OptixIntersector
/// (programs.cu), which calls optixTrace.
struct OptixTracing {
  static constexpr bool by_launch_of_pixels = true;

  template <class Stacks>
  ALHAZEN_HD static typename Stacks::Intersector intersector(const SceneView<float>& scene, const Stacks& stacks) {
    return typename Stacks::Intersector(scene, stacks);
  }
};

/// The kernel that ray generation runs. Each thread takes all samples of the slice for one pixel.
template <IntegratorKind kind>
using OptixKernel = cuda::PixelKernel<OptixTracing, kind, float>;

struct OptixParams {
  cuda::Launch<float> launch;
  BlockSum<float>* sums;  ///< one per thread
  OptixTraversableHandle traversable;
  uint32_t sbt_offset;  ///< for optixTrace: 0 if instances have offsets of their own, else the only kind of primitive
};

/// Returns whether OptiX knows a kind of primitives. For the others, it finds the boxes that a ray enters, and our own
/// test finds the hit.
constexpr bool is_built_in(PrimitiveKind kind) {
  return kind == PrimitiveKind::triangle || kind == PrimitiveKind::sphere || kind == PrimitiveKind::moving_sphere;
}

/// Number of payload words of a closest-hit query: t, b1, b2, PrimitiveId, instance.
inline constexpr unsigned closest_words = 5;
/// OptiX instances with lower ids are the kinds of primitives in the world. From this id on, they are the instances of
/// the scene.
inline constexpr unsigned first_instance_id = primitive_kinds;
/// Number of payload words of an occlusion query: 1 if the ray is occluded, else 0.
inline constexpr unsigned occlusion_words = 1;

// The records of the shader binding table, which consist of their headers.
enum RaygenRecord : unsigned { raygen_path, raygen_iterative, raygen_guided_path };

constexpr RaygenRecord raygen_of(IntegratorKind kind) {
  return kind == IntegratorKind::path          ? raygen_path
         : kind == IntegratorKind::guided_path ? raygen_guided_path
                                               : raygen_iterative;
}
enum MissRecord : unsigned { miss_closest, miss_occlusion };
inline constexpr unsigned raygen_records = 3, miss_records = 2;
inline constexpr unsigned hit_records = primitive_kinds;  ///< by PrimitiveKind

inline constexpr const char* params_name = "params";
inline constexpr const char* raygen_names[raygen_records] = {"__raygen__path", "__raygen__iterative",
                                                             "__raygen__guided_path"};
inline constexpr const char* miss_occlusion_name = "__miss__occlusion";
inline constexpr const char* intersection_names[hit_records] = {  // of kinds that are not built in
#define ALHAZEN_NAME(X, kind, Record, records, Block, blocks) "__intersection__" #kind,
    ALHAZEN_PRIMITIVES(ALHAZEN_NAME, )
#undef ALHAZEN_NAME
};
inline constexpr const char* closest_hit_names[hit_records] = {
#define ALHAZEN_NAME(X, kind, Record, records, Block, blocks) "__closesthit__" #kind,
    ALHAZEN_PRIMITIVES(ALHAZEN_NAME, )
#undef ALHAZEN_NAME
};

}  // namespace alhazen::impl::optix
