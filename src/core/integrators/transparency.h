#pragma once

// Surfaces that let rays through: by their alpha, at random, or because they have one side. Backs let rays of the
// camera through. Other rays they stop, but for three cases, which compile/open_backs.h finds: a triangle whose back
// the camera sees is absent; one of two that lie in one place, back to back, has its front alone; and where all lights
// are without size, shadow rays leave a room that the camera looks into from outside through all of its walls. Nothing
// here is run in scenes without such surfaces.

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

/// Whether any such ray may go through the surface.
template <class Real>
ALHAZEN_HD bool may_pass(const MaterialRecord<Real>& material, RayKind kind) {
  if (!(material.features & MaterialFeatures::cutout)) return false;
  if (material.opacity.count > 0 || (material.features & (MaterialFeatures::absent | MaterialFeatures::half)))
    return true;
  return kind == RayKind::camera || (kind == RayKind::shadow && (material.features & MaterialFeatures::lit_through));
}

/// Share of such rays that the surface stops.
template <class Real>
ALHAZEN_HD Real opacity(const SceneView<Real>& scene, const MaterialRecord<Real>& material, const Ray<Real>& ray,
                        const Hit<Real>& hit, const SurfaceInteraction<Real>& si, RayKind kind) {
  if (material.features & MaterialFeatures::absent) return 0;
  if (material.features & MaterialFeatures::one_sided) {
    const bool meets_back = dot(ray.direction, si.normal) > 0;
    if (meets_back && (kind == RayKind::camera || (material.features & MaterialFeatures::half))) return 0;
    if (!meets_back && kind == RayKind::shadow && (material.features & MaterialFeatures::lit_through)) return 0;
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

/// The ray that goes on where a surface lets it through. It begins just before a triangle, which is not hit again
/// (`Ray::left`): what else lies in that plane is met next. Where it had begun as close before, it begins behind.
template <class Real>
ALHAZEN_HD Ray<Real> ray_beyond(const Ray<Real>& ray, const Hit<Real>& hit, const SurfaceInteraction<Real>& si) {
  const Real clearance = 8 * dot(abs(si.normal), si.position_error);
  const bool begins_before =
      hit.primitive.kind() == PrimitiveKind::triangle && hit.t * abs_dot(si.normal, ray.direction) > clearance;
  Ray<Real> beyond = spawn_ray(si, begins_before ? -ray.direction : ray.direction);
  beyond.direction = ray.direction;
  return beyond;
}

/// Whether the ray goes on as if nothing had been met; then it is one that begins anew (ray_beyond), and `travelled`
/// has grown by what lies before.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool passes(const SceneView<Real>& scene, const Hit<Real>& hit, RayKind kind, Ray<Real>& ray,
                                    Real& travelled) {
  const MaterialRecord<Real>& material = material_met(scene, hit);
  if (!may_pass(material, kind)) return false;
  const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
  const Real share = opacity(scene, material, ray, hit, si, kind);
  if (share >= 1) return false;
  if (share > 0 && random_of_hit<Real>(hash_of_hit(ray, hit), HitChoice::passage) < share) return false;
  travelled += hit.t;
  ray = ray_beyond(ray, hit, si);
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
    if (!may_pass(material, RayKind::shadow)) return 0;
    const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
    share *= 1 - opacity(scene, material, ray, hit, si, RayKind::shadow);
    t_max -= hit.t;
    ray = ray_beyond(ray, hit, si);
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
