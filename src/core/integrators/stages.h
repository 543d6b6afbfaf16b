#pragma once

// The stages of every integrator: compute the shading point, add emission, add direct light, scatter. A megakernel runs
// them in sequence; the wavefront runs one kernel each.

#include "core/bvh/ray_intersector.h"
#include "core/integrators/sample_record.h"
#include "core/integrators/transparency.h"
#include "core/lights/light.h"
#include "core/materials/bsdf.h"
#include "core/materials/normal_maps.h"
#include "core/math/field_list.h"
#include "core/math/ray.h"
#include "core/sampling/dimensions.h"
#include "core/sampling/sampler.h"
#include "core/shapes/displacement.h"

namespace ALHAZEN_CORE {

/// A point on a surface, ready to be shaded.
template <class Real>
struct ShadingPoint {
  SurfaceInteraction<Real> si;
  Bsdf<Real> bsdf;
  Vec3<Real> wo;   ///< unit, back along the ray
  uint32_t light;  ///< index of the light if the surface is emissive, else no_light
  const MaterialRecord<Real>* material;
};

/// Selects one material of a mix for this hit.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD const MaterialRecord<Real>& mixed_material(const SceneView<Real>& scene,
                                                                   const MaterialRecord<Real>& mix,
                                                                   const TexturePoint<Real>& at, uint32_t hash) {
  const TextureEvaluator<Real> textures{scene, at};
  const MaterialRecord<Real>* material = &mix;
  // The scene compiler ensures that mixes are not cyclic; each level uses a new random number.
  for (uint32_t level = 0; material->kind == MaterialKind::mix; ++level) {
    const Real u = random_of_hit<Real>(combine32(hash, level), HitChoice::mix);
    material = scene.materials + material->mix.select(textures, u);
  }
  return *material;
}

/// Sets what depends on the material at the hit `point.si`; `frame` is that about its consistent_shading_normal.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT void set_material(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit,
                                         const Frame<Real>& frame, ShadingPoint<Real>& point) {
  point.wo = -ray.direction;
  const SurfaceRecord& surface = scene.surfaces[point.si.surface];
  point.light = surface.light;
  const TexturePoint<Real> at = texture_point(point.si, hit);
  point.material = scene.materials + surface.material;
  if (point.material->kind == MaterialKind::mix)
    point.material = &mixed_material(scene, *point.material, at, hash_of_hit(ray, hit));
  Vec3<Real> coat_normal = frame.normal;
  point.bsdf.frame = frame;
  if (point.material->features & MaterialFeatures::tangents)
    point.bsdf.frame = detailed_frame(scene, *point.material, hit, at, point.wo, point.si, coat_normal);
  const auto view = [&] {
    const Frame<Real>& f = point.bsdf.frame;
    return ClosureView<Real>{f.to_local(point.wo), random_of_hit<Real>(hash_of_hit(ray, hit), HitChoice::channel),
                             f.to_local(coat_normal)};
  };
  make_bsdf(scene, *point.material, at, view, point.bsdf);
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT ShadingPoint<Real> shading_point(const SceneView<Real>& scene, const Ray<Real>& ray,
                                                        const Hit<Real>& hit) {
  ShadingPoint<Real> point;
  meet_surface(scene, ray, hit, point.si);
  set_material(scene, ray, hit, frame_about(consistent_shading_normal(point.si, -ray.direction)), point);
  return point;
}

/// Radiance that the surface emits back along the ray.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> surface_emission(const SceneView<Real>& scene, const Hit<Real>& hit,
                                                   const ShadingPoint<Real>& point) {
  if (point.light == no_light) return {};
  const LightRecord<Real>& light = scene.lights[point.light];
  const Vec3<Real> radiance = emitted_radiance(light.radiance, light.two_sided, point.si.normal, point.wo);
  if (light.texture.count == 0 || is_zero(radiance)) return radiance;
  return radiance * emission_factor(scene, light, point_of_emission(point.si, hit));
}

/// The side of the surface from which light must arrive to be reflected back along the ray, as its normal; zero if
/// the surface may transmit light.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> side_of_light(const ShadingPoint<Real>& point) {
  if (!point.bsdf.is_one_sided()) return {};
  return face_forward(point.si.normal, point.wo);
}

/// Returns whether light samples depend on `side_of_light`.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool samples_by_side(const SceneView<Real>& scene) {
  return scene.light_tree_count > 0 || scene.triangle_emitters_count > 0 || scene.environments_count > 0;
}

/// Returns whether `wi` is on the same side of the shading normal as of the geometric normal: interpolated normals
/// alone would let light leak through closed surfaces.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool is_on_one_side(const ShadingPoint<Real>& point, const Vec3<Real>& wi) {
  return dot(wi, point.si.normal) * dot(wi, point.bsdf.frame.normal) *
             (dot(point.wo, point.si.normal) < 0 ? Real(-1) : Real(1)) *
             (dot(point.wo, point.bsdf.frame.normal) < 0 ? Real(-1) : Real(1)) >
         0;
}

/// Returns whether a scattered direction is on the other side of the surface than the ray that hit it.
template <class Real>
ALHAZEN_HD bool is_transmitted(const ShadingPoint<Real>& point, const Vec3<Real>& wi) {
  return dot(wi, point.si.normal) * dot(point.wo, point.si.normal) < 0;
}

/// Beer-Lambert transmittance over `distance` through the medium that the surface bounds.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> beer_lambert(const ShadingPoint<Real>& point, Real distance) {
  if (!(point.material->features & MaterialFeatures::absorbs) || dot(point.wo, point.si.normal) > 0)
    return splat(Real(1));
  const Vec3<Real>& sigma = point.material->absorption;
  return {std::exp(-sigma.x * distance), std::exp(-sigma.y * distance), std::exp(-sigma.z * distance)};
}

/// A ray that tests for occlusion before `t_max`.
template <class Real>
struct ShadowRay {
  Ray<Real> ray;
  Real t_max;  ///< if not above 0, nothing can occlude
};

/// Returns a contribution of a path, limited if it is indirect light and there is a limit: the image is then darker
/// than it should be.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> limited(const SceneView<Real>& scene, const Vec3<Real>& radiance, bool is_indirect) {
  if (!(scene.indirect_limit > 0) || !is_indirect) return radiance;
  const Real largest = max_component(radiance);
  return largest > scene.indirect_limit ? radiance * (scene.indirect_limit / largest) : radiance;
}

/// Receives shadow rays with the radiance to add if they are unoccluded. It limits that radiance.
template <class Receiver, class Real>
concept ShadowRayReceiver = std::invocable < const Receiver&,
        const ShadowRay<Real>
&, const Vec3<Real>& > ;

/// The shadow ray from the surface to a sampled light.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT ShadowRay<Real> shadow_ray(const SurfaceInteraction<Real>& si, const LightSample<Real>& light) {
  ShadowRay<Real> shadow{spawn_ray(si, light.direction), infinity<Real>};
  if (!light.is_finite) return shadow;
  // Rounding of the direction displaces the end point by this much; on a light seen edge-on that may be behind its
  // surface.
  const Vec3<Real> drift = splat(length(light.point - shadow.ray.origin) * rounding_bound<Real>(3));
  const Vec3<Real> target = offset_origin(light.point, light.point_error + drift, light.normal, -light.direction);
  const Vec3<Real> to_light = target - shadow.ray.origin;
  const Real distance = length(to_light);
  if (distance > 0) shadow.ray.direction = to_light * (1 / distance);
  shadow.t_max = distance > 0 ? distance * (1 - 4 * rounding_bound<Real>(3)) : Real(0);
  return shadow;
}

template <class Real, RayIntersector<Real> Intersector>
ALHAZEN_HD bool is_unoccluded(const Intersector& intersector, const ShadowRay<Real>& shadow) {
  return !(shadow.t_max > 0) || !intersector.occluded(shadow.ray, shadow.t_max);
}

/// Visibility of a light: 0 or 1 unless some material lets shadow rays through.
template <class Real, RayIntersector<Real> Intersector>
ALHAZEN_HD Real visibility_of(const SceneView<Real>& scene, const Intersector& intersector,
                              const ShadowRay<Real>& shadow) {
  if (scene.lets_light_through) return transmittance(scene, intersector, shadow.ray, shadow.t_max);
  return is_unoccluded(intersector, shadow) ? Real(1) : Real(0);
}

/// Light that arrives from one sampled light and is scattered along `wo` if unoccluded, with its MIS weight against
/// BSDF sampling.
template <class Real>
struct DirectLight {
  Vec3<Real> radiance{};
  ShadowRay<Real> shadow;
  bool is_lit = false;
};

/// Samples one light and a point on it for a surface. pdf is 0 if there is none.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_light_for(const SceneView<Real>& scene, const Sampler& sampler,
                                                          const VertexDimensions& dimensions,
                                                          const ShadingPoint<Real>& point) {
  if (scene.lights_count == 0 || point.bsdf.is_specular()) return {};
  const Vec2<Real> u = sampler.template get_2d<Real>(dimensions.light());
  const Vec3<Real> side = samples_by_side(scene) ? side_of_light(point) : Vec3<Real>{};
  return sample_light(scene, point.si.position, side, point.si.time, u, point.light);
}

/// The light that `sample_light_for` chooses, once more: samples do not hold it.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD LightChoice<Real> chosen_light(const SceneView<Real>& scene, const Sampler& sampler,
                                          const VertexDimensions& dimensions, const ShadingPoint<Real>& point) {
  const Vec3<Real> side = samples_by_side(scene) ? side_of_light(point) : Vec3<Real>{};
  return choose_light(scene, point.si.position, side, sampler.template get_2d<Real>(dimensions.light()).x);
}

/// `scattering_pdf` returns the density with which scattering finds the light, from that of sampling the BSDF.
template <class Real, class ScatteringPdf>
ALHAZEN_HD ALHAZEN_HOT DirectLight<Real> direct_light(const ShadingPoint<Real>& point, const LightSample<Real>& light,
                                                      const ScatteringPdf& scattering_pdf) {
  DirectLight<Real> direct;
  if (!(light.pdf > 0) || is_zero(light.radiance) || !is_on_one_side(point, light.direction)) return direct;
  const BsdfValue<Real> f = evaluate_bsdf(point.bsdf, point.wo, light.direction);
  if (is_zero(f.value)) return direct;
  const Real weight = light.is_delta ? Real(1) : power_heuristic(light.pdf, scattering_pdf(f.pdf));
  direct.radiance = f.value * light.radiance * (weight / light.pdf);
  direct.shadow = shadow_ray(point.si, light);
  direct.is_lit = true;
  return direct;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT DirectLight<Real> direct_light(const ShadingPoint<Real>& point, const LightSample<Real>& light) {
  return direct_light(point, light, [](Real pdf_of_bsdf) { return pdf_of_bsdf; });
}

/// Counts a light sample by the kind of its light, which is chosen once more, and of the closure.
template <class Real, SamplerOf<Real> Sampler, class Record>
ALHAZEN_HD void count_light_sample(const SceneView<Real>& scene, const Sampler& sampler,
                                   const VertexDimensions& dimensions, const ShadingPoint<Real>& point,
                                   const LightSample<Real>& sample, const DirectLight<Real>& direct, Record& record) {
  if (scene.lights_count == 0 || point.bsdf.is_specular()) return;
  const LightChoice<Real> choice = chosen_light(scene, sampler, dimensions, point);
  if (!(choice.pmf > 0)) return;
  const bool is_unlit = !(sample.pdf > 0) || is_zero(sample.radiance);
  record.counters.count_light_sample(scene.lights[choice.light].kind, point.bsdf.kind, is_unlit,
                                     !is_unlit && !direct.is_lit);
}

template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> scatter(const ShadingPoint<Real>& point, const Sampler& sampler,
                                                const VertexDimensions& dimensions) {
  // Random numbers that are not used are not generated.
  const bool has_lobes = has_trait<&MaterialTraits::has_lobes>(point.bsdf.kind);
  const Real u_lobe = has_lobes ? sampler.template get_1d<Real>(dimensions.bsdf_lobe()) : Real(0);
  const Vec2<Real> u =
      point.bsdf.is_specular() ? Vec2<Real>{} : sampler.template get_2d<Real>(dimensions.bsdf_direction());
  BsdfSample<Real> s = sample_bsdf(point.bsdf, point.wo, u_lobe, u);
  if (s.pdf > 0 && !is_on_one_side(point, s.direction)) s.pdf = 0;
  return s;
}

template <class Real, RecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_HOT void record_first_hit(const ShadingPoint<Real>& point, Real distance, Record& record) {
  if (record.wants_first_hit())
    record.keep_first_hit(FirstHit<Real>{bsdf_albedo(point.bsdf), point.si.shading_normal, distance});
}

/// Radiance that a ray of a recursive integrator finds where it escapes.
template <class Real, RecordOf<Real> Record>
ALHAZEN_HD Vec3<Real> escape(const SceneView<Real>& scene, const Vec3<Real>& direction, uint32_t segment,
                             Record& record) {
  if (segment == 0) record.transparency = 1;
  return segment == 0 && scene.hides_background ? Vec3<Real>{} : background_radiance(scene, direction);
}

/// Records where the camera ray hits.
template <class Real, RecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_COLD void record_first_point(const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                                Record& record) {
  if (!record.wants_first_point()) return;
  const SurfaceInteraction<Real>& si = point.si;
  const SurfaceRecord& surface = scene.surfaces[si.surface];
  const bool is_placed = si.instance != no_instance && scene.instances[si.instance].object_id != no_id;
  record.keep_first_point(FirstPoint<Real>{si.position, displacement_over_shutter(scene, si), si.uv,
                                           is_placed ? scene.instances[si.instance].object_id : surface.object_id,
                                           surface.material_id});
}

}  // namespace ALHAZEN_CORE
