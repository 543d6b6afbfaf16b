#pragma once

// Surfaces that let rays through: by their alpha, at random, or because they have one side and the camera looks at
// their back. Backs let rays of the camera through; other rays they stop, unless the triangle has been found to be
// absent (scene/open_backs.h). Nothing here is run in scenes without such surfaces.

#include "core/materials/bsdf.h"
#include "core/math/ray.h"
#include "core/sampling/hash.h"
#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD inline uint32_t bits_of(float x) { return __builtin_bit_cast(uint32_t, x); }
ALHAZEN_HD inline uint32_t bits_of(double x) {
  const uint64_t bits = __builtin_bit_cast(uint64_t, x);
  return static_cast<uint32_t>(bits ^ (bits >> 32));
}

/// Random bits that belong to this ray and what it met: for choices that take no dimension of the sampler.
template <class Real>
ALHAZEN_HD uint32_t hash_of_hit(const Ray<Real>& ray, const Hit<Real>& hit) {
  uint32_t h = combine32(hit.primitive.bits ^ mix32(hit.instance), bits_of(hit.t));
  h = combine32(h, bits_of(ray.direction.x));
  h = combine32(h, bits_of(ray.direction.y));
  h = combine32(h, bits_of(ray.direction.z));
  return combine32(h, bits_of(ray.origin.x));
}

/// No ray goes through more surfaces than these: should one not get away from where it is, it ends.
inline constexpr uint32_t most_passages = 1u << 16;

/// Which choice a hash is for.
enum class HitChoice : uint32_t { passage = 1, mix = 2, channel = 3 };

template <class Real>
ALHAZEN_HD Real random_of_hit(uint32_t hash, HitChoice choice) {
  return unit_interval<Real>(combine32(hash, static_cast<uint32_t>(choice)));
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Ray<Real> spawn_ray(const SurfaceInteraction<Real>& si, const Vec3<Real>& direction) {
  return {offset_origin(si.position, si.position_error, si.normal, direction), direction, si.time, si.primitive,
          si.instance};
}

/// Who asks whether a surface lets a ray through: the camera's ray, before anything has scattered it, one that a
/// surface has scattered, or a shadow ray, which goes against the light.
enum class RayKind : uint32_t { camera, scattered, shadow };

/// Share of such rays that the surface stops.
template <class Real>
ALHAZEN_HD Real opacity(const SceneView<Real>& scene, const MaterialRecord<Real>& material, const Ray<Real>& ray,
                        const Hit<Real>& hit, const SurfaceInteraction<Real>& si, RayKind kind) {
  if (material.features & MaterialFeatures::absent) return 0;
  if (material.features & MaterialFeatures::one_sided) {
    const bool meets_back = dot(ray.direction, si.normal) > 0;
    if (kind == RayKind::camera && meets_back) return 0;
    if (kind == RayKind::shadow && scene.light_passes_backs && !meets_back) return 0;
  }
  if (material.opacity.count == 0) return 1;
  return clamp(evaluate_texture(scene, material.opacity, texture_point(si, hit)).x, Real(0), Real(1));
}

/// Of a path that has met so many surfaces.
ALHAZEN_HD inline RayKind ray_kind(uint32_t vertex) { return vertex == 0 ? RayKind::camera : RayKind::scattered; }

template <class Real>
ALHAZEN_HD const MaterialRecord<Real>& material_met(const SceneView<Real>& scene, const Hit<Real>& hit) {
  return scene.materials[scene.surfaces[surface_of(scene, hit.primitive)].material];
}

/// Whether the ray goes on as if nothing had been met; then it begins anew behind the surface, and `travelled` has
/// grown by what lies before.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool passes(const SceneView<Real>& scene, const Hit<Real>& hit, RayKind kind, Ray<Real>& ray,
                                    Real& travelled) {
  const MaterialRecord<Real>& material = material_met(scene, hit);
  if (!(material.features & MaterialFeatures::cutout)) return false;
  const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
  const Real share = opacity(scene, material, ray, hit, si, kind);
  if (share >= 1) return false;
  if (share > 0 && random_of_hit<Real>(hash_of_hit(ray, hit), HitChoice::passage) < share) return false;
  travelled += hit.t;
  ray = spawn_ray(si, ray.direction);
  return true;
}

/// Share of light that arrives over a way of length `t_max`.
template <class Real, class Intersector>
ALHAZEN_HD Real transmittance(const SceneView<Real>& scene, const Intersector& intersector, Ray<Real> ray, Real t_max) {
  Real share = 1;
  Hit<Real> hit;
  for (uint32_t i = 0; share > 0 && t_max > 0 && intersector.closest_hit(ray, t_max, hit); ++i) {
    if (i == most_passages) return 0;
    const MaterialRecord<Real>& material = material_met(scene, hit);
    if (!(material.features & MaterialFeatures::cutout)) return 0;
    const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
    share *= 1 - opacity(scene, material, ray, hit, si, RayKind::shadow);
    t_max -= hit.t;
    ray = spawn_ray(si, ray.direction);
  }
  return share;
}

/// closest_hit of what stops the ray, which may begin behind surfaces afterwards.
template <class Real, class Intersector>
ALHAZEN_HD bool closest_stop(const SceneView<Real>& scene, const Intersector& intersector, RayKind kind, Ray<Real>& ray,
                             Hit<Real>& hit, Real& travelled) {
  for (uint32_t i = 0; i < most_passages && intersector.closest_hit(ray, infinity<Real>, hit); ++i)
    if (!scene.has_cutouts || !passes(scene, hit, kind, ray, travelled)) return true;
  return false;
}

}  // namespace ALHAZEN_CORE
