// The OptiX device programs. Ray generation runs the integrators of the core. Hit programs only return the hit
// primitive, its instance, t and the barycentric coordinates.

#include <optix.h>

#include "backends/optix/module/params.h"
#include "core/bvh/bvh2/traversal.h"

namespace alhazen::impl::optix {

// A byte array, since variables in constant memory cannot have constructors.
extern "C" {
__constant__ __align__(16) unsigned char params[sizeof(OptixParams)];
}

__device__ inline const OptixParams& launch_params() { return *reinterpret_cast<const OptixParams*>(params); }

/// Answers ray queries with optixTrace.
///
/// Hits on spheres are verified with our own, robust test: the built-in one computes in float from the centre of the
/// sphere, and on a ground sphere of radius 1000 it may hit the surface that the ray starts on. The triangle that the
/// ray starts on is skipped (`Ray::left`). Hits on kinds that are not built in are those of our own test already.
class OptixIntersector {
 public:
  template <class Stacks>
  __device__ OptixIntersector(const SceneView<float>& scene, const Stacks&) : scene_(&scene) {}

  __device__ bool closest_hit(const Ray<float>& ray, float t_max, Hit<float>& hit) const {
    hit = end_of_interval(t_max);
    bool found = false;
    float t_min = 0;
    for (int attempt = 0; attempt < max_attempts && t_min < hit.t; ++attempt) {
      Hit<float> candidate;
      if (!trace(ray, t_min, hit.t, OPTIX_RAY_FLAG_DISABLE_ANYHIT, candidate)) break;
      if (!is_sphere(candidate.primitive)) {
        if (is_left(ray, candidate)) {
          t_min = next_towards(candidate.t, 1.0f);
          continue;
        }
        hit = candidate;
        return true;
      }
      // If our own test hits the sphere farther away or not at all, another primitive may be closer.
      t_min = candidate.t + beyond(candidate);
      if (!intersects_sphere(ray, candidate.primitive, hit)) continue;
      found = true;
      if (hit.t <= candidate.t) break;
    }
    return found;
  }

  __device__ bool occluded(const Ray<float>& ray, float t_max) const {
    constexpr unsigned flags = OPTIX_RAY_FLAG_DISABLE_ANYHIT | OPTIX_RAY_FLAG_TERMINATE_ON_FIRST_HIT;
    // A miss is final. A hit is traced again, since only the hit programs return which primitive it is.
    if (!is_anything_between(ray, t_max, flags | OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT)) return false;
    Hit<float> candidate, own = end_of_interval(t_max);
    if (!trace(ray, 0, t_max, flags, candidate)) return false;
    if (is_sphere(candidate.primitive) ? intersects_sphere(ray, candidate.primitive, own) : !is_left(ray, candidate))
      return true;
    return closest_hit(ray, t_max, own);
  }

 private:
  static constexpr int max_attempts = 8;

  /// Returns whether the hit is on the triangle that the ray starts on, which cannot be hit.
  __device__ static bool is_left(const Ray<float>& ray, const Hit<float>& candidate) {
    return candidate.primitive.kind() == PrimitiveKind::triangle && candidate.primitive == ray.left &&
           candidate.instance == ray.left_instance;
  }

  __device__ static bool is_sphere(PrimitiveId id) {
    return id.kind() == PrimitiveKind::sphere || id.kind() == PrimitiveKind::moving_sphere;
  }

  __device__ static float3 vector(const Vec3<float>& v) { return {v.x, v.y, v.z}; }

  __device__ static bool trace(const Ray<float>& ray, float t_min, float t_max, unsigned flags, Hit<float>& hit) {
    const OptixParams& launch = launch_params();
    unsigned t = 0, b1 = 0, b2 = 0, primitive = PrimitiveId().bits, instance = no_instance;
    optixTrace(OPTIX_PAYLOAD_TYPE_ID_0, launch.traversable, vector(ray.origin), vector(ray.direction), t_min, t_max,
               ray.time, 0xff, flags, launch.sbt_offset, 0, miss_closest, t, b1, b2, primitive, instance);
    hit.t = __uint_as_float(t);
    hit.b1 = __uint_as_float(b1);
    hit.b2 = __uint_as_float(b2);
    hit.primitive.bits = primitive;
    hit.instance = instance;
    return !hit.primitive.is_none();
  }

  __device__ static bool is_anything_between(const Ray<float>& ray, float t_max, unsigned flags) {
    const OptixParams& launch = launch_params();
    unsigned occluded = 1;
    optixTrace(OPTIX_PAYLOAD_TYPE_ID_1, launch.traversable, vector(ray.origin), vector(ray.direction), 0.0f, t_max,
               ray.time, 0xff, flags, launch.sbt_offset, 0, miss_occlusion, occluded);
    return occluded != 0;
  }

  /// Intersects a sphere with our own test; a hit that precedes `hit` replaces it.
  __device__ bool intersects_sphere(const Ray<float>& ray, PrimitiveId sphere, Hit<float>& hit) const {
    return intersect_primitive(*scene_, sphere, ray, ShearedRay<float>{}, hit);
  }

  /// Returns a step along the ray that passes a hit that OptiX found on a sphere.
  __device__ float beyond(const Hit<float>& candidate) const {
    const uint32_t index = candidate.primitive.index();
    const bool moves = candidate.primitive.kind() == PrimitiveKind::moving_sphere;
    return 1e-5f * candidate.t + 1e-6f * (moves ? scene_->moving_spheres[index].radius : scene_->spheres[index].radius);
  }

  const SceneView<float>* scene_;
};

static_assert(RayIntersector<OptixIntersector, float>);

struct OptixStacks {
  using Intersector = OptixIntersector;
};

class OptixThread {
 public:
  __device__ uint32_t x() const { return optixGetLaunchIndex().x; }
  __device__ uint32_t y() const { return optixGetLaunchIndex().y; }
  __device__ OptixStacks stacks() const { return {}; }
  __device__ void add(unsigned long long* total, uint32_t value) const {
    atomicAdd(total, static_cast<unsigned long long>(value));
  }
};

template <IntegratorKind kind>
__device__ void generate_rays() {
  OptixKernel<kind>{launch_params().launch, 1, 1, launch_params().sums}(OptixThread());
}

__device__ void report(PrimitiveId primitive, uint32_t instance, float b1, float b2) {
  optixSetPayload_0(__float_as_uint(optixGetRayTmax()));
  optixSetPayload_1(__float_as_uint(b1));
  optixSetPayload_2(__float_as_uint(b2));
  optixSetPayload_3(primitive.bits);
  optixSetPayload_4(instance);
}

extern "C" __global__ void __raygen__path() { generate_rays<IntegratorKind::path>(); }

extern "C" __global__ void __raygen__iterative() { generate_rays<IntegratorKind::iterative>(); }

extern "C" __global__ void __raygen__guided_path() { generate_rays<IntegratorKind::guided_path>(); }

extern "C" __global__ void __miss__occlusion() {
  optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
  optixSetPayload_0(0);
}

__device__ void report_triangle() {
  const float2 weights = optixGetTriangleBarycentrics();
  const SceneView<float>& scene = launch_params().launch.scene;
  uint32_t instance = no_instance, triangle = optixGetPrimitiveIndex();
  if (scene.instances_count > 0 && optixGetInstanceId() >= first_instance_id) {
    instance = optixGetInstanceId() - first_instance_id;
    triangle += scene.objects[scene.instances[instance].object].first_triangle;
  }
  report({PrimitiveKind::triangle, triangle}, instance, weights.x, weights.y);
}

template <PrimitiveKind kind>
__device__ void intersect_custom() {
  if constexpr (!is_built_in(kind)) {
    const SceneView<float>& scene = launch_params().launch.scene;
    const uint32_t index = optixGetPrimitiveIndex();
    const float3 origin = optixGetWorldRayOrigin(), direction = optixGetWorldRayDirection();
    const Ray<float> ray{{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, optixGetRayTime()};
    Hit<float> hit;
    if (intersect_record(scene, records_of<kind>(scene)[index], {kind, index}, ray, ShearedRay<float>{},
                         optixGetRayTmax(), hit))
      optixReportIntersection(hit.t, 0);
  }
}

#define ALHAZEN_HIT_PROGRAMS(X, kind, Record, records, Block, blocks)                              \
  extern "C" __global__ void __intersection__##kind() { intersect_custom<PrimitiveKind::kind>(); } \
  extern "C" __global__ void __closesthit__##kind() {                                              \
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);                                                 \
    if constexpr (PrimitiveKind::kind == PrimitiveKind::triangle)                                  \
      report_triangle();                                                                           \
    else                                                                                           \
      report({PrimitiveKind::kind, optixGetPrimitiveIndex()}, no_instance, 0, 0);                  \
  }
ALHAZEN_PRIMITIVES(ALHAZEN_HIT_PROGRAMS, )
#undef ALHAZEN_HIT_PROGRAMS

}  // namespace alhazen::impl::optix
