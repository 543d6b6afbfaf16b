#pragma once

// Surfaces that let rays through: by their alpha, at random (alpha test), or because they are one-sided. Camera rays
// pass through back faces. Other rays are stopped by them, with three exceptions, which compile/open_backs.h finds: a
// triangle whose back the camera sees is absent; of two coincident triangles, back to back, each has its front alone;
// and if all lights are delta lights, shadow rays leave a room that the camera looks into from outside through all of
// its walls. Scenes without such surfaces run none of this code.

#include "core/bvh/ray_intersector.h"
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

/// Random bits derived from a ray and its hit, for choices that use no dimension of the sampler.
template <class Real>
ALHAZEN_HD uint32_t hash_of_hit(const Ray<Real>& ray, const Hit<Real>& hit) {
  // Kinds from the fifth on are not told apart here.
  const uint32_t primitive = static_cast<uint32_t>(hit.primitive.kind()) << 30 ^ hit.primitive.index();
  uint32_t h = combine32(primitive ^ mix32(hit.instance), bits_of(hit.t));
  h = combine32(h, bits_of(ray.direction.x));
  h = combine32(h, bits_of(ray.direction.y));
  h = combine32(h, bits_of(ray.direction.z));
  return combine32(h, bits_of(ray.origin.x));
}

/// Maximum number of surfaces that a ray passes through; then it ends, in case it makes no progress.
inline constexpr uint32_t max_transparent_hits = 1u << 16;

/// The purpose of a hash.
enum class HitChoice : uint32_t { alpha = 1, mix = 2, channel = 3 };

template <class Real>
ALHAZEN_HD Real random_of_hit(uint32_t hash, HitChoice choice) {
  return unit_interval<Real>(combine32(hash, static_cast<uint32_t>(choice)));
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Ray<Real> spawn_ray(const SurfaceInteraction<Real>& si, const Vec3<Real>& direction) {
  return {offset_origin(si.position, si.position_error, si.normal, direction), direction, si.time, si.primitive,
          si.instance};
}

/// The kind of ray for which a surface may be transparent: a camera ray before any scattering, a scattered ray, or a
/// shadow ray, which travels against the light.
enum class RayKind : uint32_t { camera, scattered, shadow };

/// Returns whether a ray of this kind may pass through the surface.
template <class Real>
ALHAZEN_HD bool may_pass(const MaterialRecord<Real>& material, RayKind kind) {
  if (!(material.features & MaterialFeatures::cutout)) return false;
  if (material.opacity.count > 0 || (material.features & (MaterialFeatures::absent | MaterialFeatures::half)))
    return true;
  return kind == RayKind::camera || (kind == RayKind::shadow && (material.features & MaterialFeatures::lit_through));
}

/// Fraction of rays of this kind that the surface stops.
template <class Real>
ALHAZEN_HD Real opacity(const SceneView<Real>& scene, const MaterialRecord<Real>& material, const Ray<Real>& ray,
                        const Hit<Real>& hit, const SurfaceInteraction<Real>& si, RayKind kind) {
  if (material.features & MaterialFeatures::absent) return 0;
  if (material.features & MaterialFeatures::one_sided) {
    const bool hits_back = dot(ray.direction, si.normal) > 0;
    if (hits_back && (kind == RayKind::camera || (material.features & MaterialFeatures::half))) return 0;
    if (!hits_back && kind == RayKind::shadow && (material.features & MaterialFeatures::lit_through)) return 0;
  }
  if (material.opacity.count == 0) return 1;
  return clamp(evaluate_texture(scene, material.opacity, texture_point(si, hit)).x, Real(0), Real(1));
}

/// The kind of the rays of a path that has hit `vertex` surfaces.
ALHAZEN_HD inline RayKind ray_kind(uint32_t vertex) { return vertex == 0 ? RayKind::camera : RayKind::scattered; }

template <class Real>
ALHAZEN_HD const MaterialRecord<Real>& material_of_hit(const SceneView<Real>& scene, const Hit<Real>& hit) {
  return scene.materials[scene.surfaces[surface_of(scene, hit.primitive)].material];
}

/// Continues a ray beyond a surface that it passes through. It starts just before a triangle, which it cannot hit again
/// (`Ray::left`), so that coplanar surfaces are hit next. If it had started that close already, it starts behind.
template <class Real>
ALHAZEN_HD Ray<Real> ray_beyond(const Ray<Real>& ray, const Hit<Real>& hit, const SurfaceInteraction<Real>& si) {
  const Real clearance = 8 * dot(abs(si.normal), si.position_error);
  const bool begins_before =
      hit.primitive.kind() == PrimitiveKind::triangle && hit.t * abs_dot(si.normal, ray.direction) > clearance;
  Ray<Real> beyond = spawn_ray(si, begins_before ? -ray.direction : ray.direction);
  beyond.direction = ray.direction;
  return beyond;
}

/// Returns whether the ray passes through the hit surface. If so, `ray` is continued (ray_beyond) and `travelled` grows
/// by the distance to the hit.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool passes(const SceneView<Real>& scene, const Hit<Real>& hit, RayKind kind, Ray<Real>& ray,
                                    Real& travelled) {
  const MaterialRecord<Real>& material = material_of_hit(scene, hit);
  if (!may_pass(material, kind)) return false;
  const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
  const Real surface_opacity = opacity(scene, material, ray, hit, si, kind);
  if (surface_opacity >= 1) return false;
  if (surface_opacity > 0 && random_of_hit<Real>(hash_of_hit(ray, hit), HitChoice::alpha) < surface_opacity)
    return false;
  travelled += hit.t;
  ray = ray_beyond(ray, hit, si);
  return true;
}

/// Continues a shadow ray beyond a surface, over what is left of the distance `t_max`: `transmitted` falls by what the
/// surface stops, to 0 if no light passes.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void pass_light(const SceneView<Real>& scene, const Hit<Real>& hit, Ray<Real>& ray, Real& t_max,
                                        Real& transmitted) {
  const MaterialRecord<Real>& material = material_of_hit(scene, hit);
  if (!may_pass(material, RayKind::shadow)) {
    transmitted = 0;
    return;
  }
  const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
  transmitted *= 1 - opacity(scene, material, ray, hit, si, RayKind::shadow);
  t_max -= hit.t;
  ray = ray_beyond(ray, hit, si);
}

/// Fraction of light that arrives along the ray over the distance `t_max`.
template <class Real, RayIntersector<Real> Intersector>
ALHAZEN_HD Real transmittance(const SceneView<Real>& scene, const Intersector& intersector, Ray<Real> ray, Real t_max) {
  Real transmitted = 1;
  Hit<Real> hit;
  for (uint32_t i = 0; transmitted > 0 && t_max > 0 && intersector.closest_hit(ray, t_max, hit); ++i) {
    if (i == max_transparent_hits) return 0;
    pass_light(scene, hit, ray, t_max, transmitted);
  }
  return transmitted;
}

/// Finds the closest hit that stops the ray; the ray may then start behind surfaces that it passed through.
template <class Real, RayIntersector<Real> Intersector>
ALHAZEN_HD bool closest_stop(const SceneView<Real>& scene, const Intersector& intersector, RayKind kind, Ray<Real>& ray,
                             Hit<Real>& hit, Real& travelled) {
  for (uint32_t i = 0; i < max_transparent_hits && intersector.closest_hit(ray, infinity<Real>, hit); ++i)
    if (!scene.has_cutouts || !passes(scene, hit, kind, ray, travelled)) return true;
  return false;
}

}  // namespace ALHAZEN_CORE
