#pragma once

// The stages that every integrator is made of: meet the surface, gather emission, light it directly, scatter.
// A megakernel runs them in a row, queues one kernel each.

#include "core/lights/light.h"
#include "core/materials/bsdf.h"
#include "core/math/ray.h"
#include "core/sampling/dimensions.h"

namespace alhazen {

/// What one camera sample brings back: its radiance, what the camera ray met first, and what it cost.
template <class Real>
struct SampleRecord {
  Vec3<Real> radiance{};
  Vec3<Real> albedo{}, normal{};  ///< of the first surface; the normal is the shading normal, in world space
  Real depth = 0;                 ///< distance to it from the lens, scene units
  uint32_t has_hit = 0;           ///< 1 where there was one
  uint32_t segments = 0;          ///< closest-hit rays, the report's bounces
  uint32_t shadow_rays = 0;
};

/// A point on a surface, ready to be shaded.
template <class Real>
struct ShadingPoint {
  SurfaceInteraction<Real> si;
  Bsdf<Real> bsdf;
  Vec3<Real> wo;   ///< unit, back along the ray
  uint32_t light;  ///< the light that this surface is, or no_light
};

template <class Real>
ALHAZEN_HD ShadingPoint<Real> shading_point(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit) {
  ShadingPoint<Real> point;
  point.si = surface_interaction(scene, ray, hit);
  point.wo = -ray.direction;
  const SurfaceRecord& surface = scene.surfaces[point.si.surface];
  point.light = surface.light;
  point.bsdf = make_bsdf(scene, scene.materials[surface.material], TexturePoint<Real>{point.si.position, point.si.uv},
                         consistent_shading_normal(point.si, point.wo));
  return point;
}

/// Radiance that the surface itself sends back along the ray.
template <class Real>
ALHAZEN_HD Vec3<Real> surface_emission(const SceneView<Real>& scene, const ShadingPoint<Real>& point) {
  return point.light == no_light ? Vec3<Real>{}
                                 : emitted_radiance(scene.lights[point.light], point.si.normal, point.wo);
}

/// Whether `wi` lies on the same side of the shading normal as of the surface: interpolated normals alone would let
/// light through closed surfaces.
template <class Real>
ALHAZEN_HD bool is_on_one_side(const ShadingPoint<Real>& point, const Vec3<Real>& wi) {
  return dot(wi, point.si.normal) * dot(wi, point.bsdf.frame.normal) *
             (dot(point.wo, point.si.normal) < 0 ? Real(-1) : Real(1)) *
             (dot(point.wo, point.bsdf.frame.normal) < 0 ? Real(-1) : Real(1)) >
         0;
}

template <class Real>
ALHAZEN_HD Ray<Real> spawn_ray(const SurfaceInteraction<Real>& si, const Vec3<Real>& direction) {
  return {offset_origin(si.position, si.position_error, si.normal, direction), direction, si.time};
}

/// Whether the way from the surface to a sampled light is free.
template <class Real, class Intersector>
ALHAZEN_HD bool is_visible(const Intersector& intersector, const SurfaceInteraction<Real>& si,
                           const LightSample<Real>& light) {
  Ray<Real> ray = spawn_ray(si, light.direction);
  if (!light.is_finite) return !intersector.occluded(ray, infinity<Real>);
  // The rounded direction misses its aim by so much, which on a light seen from the edge is a way behind the surface.
  const Vec3<Real> drift = splat(length(light.point - ray.origin) * rounding_bound<Real>(3));
  const Vec3<Real> target = offset_origin(light.point, light.point_error + drift, light.normal, -light.direction);
  const Vec3<Real> way = target - ray.origin;
  const Real distance = length(way);
  if (!(distance > 0)) return true;
  ray.direction = way * (1 / distance);
  return !intersector.occluded(ray, distance * (1 - 4 * rounding_bound<Real>(3)));
}

/// Light from one sampled light by way of this point, weighted against finding it by chance.
template <class Real, class Intersector, class Sampler>
ALHAZEN_HD Vec3<Real> direct_light(const SceneView<Real>& scene, const Intersector& intersector, const Sampler& sampler,
                                   const VertexDimensions& dimensions, const ShadingPoint<Real>& point,
                                   SampleRecord<Real>& record) {
  if (scene.lights_count == 0 || point.bsdf.is_specular()) return {};
  const LightSample<Real> light =
      sample_light(scene, point.si.position, point.si.time, sampler.template get_1d<Real>(dimensions.light_choice()),
                   sampler.template get_2d<Real>(dimensions.light_point()));
  if (!(light.pdf > 0) || is_zero(light.radiance) || !is_on_one_side(point, light.direction)) return {};
  const BsdfValue<Real> f = evaluate_bsdf(point.bsdf, point.wo, light.direction);
  if (is_zero(f.value)) return {};
  ++record.shadow_rays;
  if (!is_visible(intersector, point.si, light)) return {};
  const Real weight = light.is_delta ? Real(1) : power_heuristic(light.pdf, f.pdf);
  return f.value * light.radiance * (weight / light.pdf);
}

template <class Real, class Sampler>
ALHAZEN_HD BsdfSample<Real> scatter(const ShadingPoint<Real>& point, const Sampler& sampler,
                                    const VertexDimensions& dimensions) {
  BsdfSample<Real> s = sample_bsdf(point.bsdf, point.wo, sampler.template get_1d<Real>(dimensions.bsdf_lobe()),
                                   sampler.template get_2d<Real>(dimensions.bsdf_direction()));
  if (s.pdf > 0 && !is_on_one_side(point, s.direction)) s.pdf = 0;
  return s;
}

template <class Real>
ALHAZEN_HD void record_first_hit(const ShadingPoint<Real>& point, const Hit<Real>& hit, SampleRecord<Real>& record) {
  record.has_hit = 1;
  record.albedo = bsdf_albedo(point.bsdf);
  record.normal = point.si.shading_normal;
  record.depth = hit.t;
}

}  // namespace alhazen
