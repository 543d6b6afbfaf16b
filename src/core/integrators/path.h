#pragma once

// Path tracing with next-event estimation, multiple importance sampling and Russian roulette
// (Kajiya 1986; Veach 1997, chapters 9 and 10).

#include "core/integrators/stages.h"
#include "core/math/field_list.h"

namespace ALHAZEN_CORE {

/// The state of a path between two segments.
template <class Real>
struct PathState {
  Ray<Real> ray;
  Vec3<Real> throughput = splat(Real(1));
  Real bsdf_pdf = 0;             ///< of the ray's direction
  Real eta_scale = 1;            ///< product of eta^2 over refractions, undone for roulette
  uint32_t vertex = 0;           ///< number of surfaces hit so far
  bool is_specular = true;       ///< light sampling could not have found this direction
  bool awaits_first_hit = true;  ///< what it hits is the first that is recorded of it
  bool is_seen_through = true;   ///< all surfaces so far were specular and transmitted it
  Vec3<Real> light_side{};       ///< `side_of_light` of the last surface, if light samples depend on it
  Real travelled = 0;            ///< distance before the ray's origin, through surfaces that the ray passed through

  using Fields = FieldList<&PathState::ray, &PathState::throughput, &PathState::bsdf_pdf, &PathState::eta_scale,
                           &PathState::vertex, &PathState::is_specular, &PathState::awaits_first_hit,
                           &PathState::is_seen_through, &PathState::light_side, &PathState::travelled>;
};

/// MIS weight of light found by BSDF sampling, where light sampling has density `light_pdf`.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real bsdf_mis_weight(const PathState<Real>& path, Real light_pdf) {
  return path.is_specular ? Real(1) : power_heuristic(path.bsdf_pdf, light_pdf);
}

/// The albedo of what is seen after perfectly specular surfaces, times their colours.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> albedo_in_specular(const PathState<Real>& path, const Vec3<Real>& albedo) {
  return min(albedo * path.throughput * path.eta_scale, splat(Real(1)));
}

/// Records a path that has met nothing but specular surfaces: what it sees is as white as they let it be, faces it, and
/// has no distance.
template <class Real, class Record>
ALHAZEN_HD ALHAZEN_COLD void record_escape(const PathState<Real>& path, Record& record) {
  if (record.wants_first_hit())
    record.keep_first_hit(FirstHit<Real>{albedo_in_specular(path, splat(Real(1))), -path.ray.direction, Real(0)});
}

/// Records that a path shows the background through glass, whose tint is not transparent. Returns whether the
/// background is hidden there.
template <class Real, class Record>
ALHAZEN_HD ALHAZEN_COLD bool record_glass(const SceneView<Real>& scene, const PathState<Real>& path, Record& record) {
  const Vec3<Real> tint = path.throughput * path.eta_scale;
  if (!is_finite(tint)) return false;  // then the radiance is not finite either, and the sample counts as such
  record.transparency = min((tint.x + tint.y + tint.z) * Real(1.0 / 3), Real(1));
  return scene.hides_background != 0;
}

/// Adds emission that the path finds. `group` is called for the light's group, if that is wanted.
template <class Real, class Record, class Group>
ALHAZEN_HD ALHAZEN_HOT void add_found(const PathState<Real>& path, const Vec3<Real>& radiance, const Group& group,
                                      Record& record) {
  record.radiance += radiance;
  if (record.parts) record.parts->add_found(path.vertex, group(), radiance);
}

template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT void add_infinite_lights(const SceneView<Real>& scene, const PathState<Real>& path,
                                                Record& record) {
  if (path.vertex > 0 && path.awaits_first_hit) record_escape(path, record);
  if (path.is_seen_through) {
    if (path.vertex == 0) record.transparency = 1;
    if (path.vertex == 0 ? scene.hides_background != 0 : scene.sees_through_glass && record_glass(scene, path, record))
      return;
  }
  // The constant light is not sampled, so its weight is 1.
  const bool is_indirect = path.vertex >= 2;
  if (!is_zero(scene.background))
    add_found(
        path, limited(scene, path.throughput * scene.background, is_indirect), [&] { return scene.background_group; },
        record);
  if (scene.far_lights_count == 0) return;
  Real at_infinity = 0;  // the probability that light sampling chooses one of these lights
  if (!path.is_specular) {
    const Vec3<Real> start = path.ray.origin - path.ray.direction * path.travelled;
    at_infinity = 1 - light_tree_probability(scene, start, path.light_side);
  }
  for (uint32_t i = 0; i < scene.far_lights_count; ++i) {
    const LightRecord<Real>& light = scene.lights[scene.far_lights[i]];
    const Real pmf = light.pmf * at_infinity;
    const EscapedLight<Real> found = escaped_light(scene, light, path.light_side, path.ray.direction, pmf > 0);
    if (is_zero(found.radiance)) continue;
    const Real weight = bsdf_mis_weight(path, pmf > 0 ? pmf * found.pdf : Real(0));
    add_found(
        path, limited(scene, path.throughput * found.radiance * weight, is_indirect),
        [&] { return light_group(scene, scene.far_lights[i]); }, record);
  }
}

template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT void gather_emission(const SceneView<Real>& scene, const PathState<Real>& path,
                                            const Hit<Real>& hit, const ShadingPoint<Real>& point, Record& record) {
  const Vec3<Real> emission = surface_emission(scene, hit, point);
  if (is_zero(emission)) return;
  Real light_pdf = 0;
  if (!path.is_specular) {
    if (path.travelled > 0) {
      // The ray as it left the point at which the light would have been sampled.
      const Ray<Real> whole{path.ray.origin - path.ray.direction * path.travelled, path.ray.direction, path.ray.time};
      const Hit<Real> end{hit.t + path.travelled, hit.b1, hit.b2, hit.primitive, hit.instance};
      light_pdf = pdf_light(scene, scene.lights[point.light], whole, end, point.si, path.light_side);
    } else {
      light_pdf = pdf_light(scene, scene.lights[point.light], path.ray, hit, point.si, path.light_side);
    }
  }
  add_found(
      path, limited(scene, path.throughput * emission * bsdf_mis_weight(path, light_pdf), path.vertex >= 2),
      [&] { return light_group(scene, point.light); }, record);
}

/// Returns whether a path that has only been transmitted still is after this sample: by a surface so smooth that what
/// is behind it is seen sharply.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool is_seen_through(const ShadingPoint<Real>& point, const BsdfSample<Real>& s) {
  return is_transmitted(point, s.direction) && (s.specular || transmits_sharply(point.bsdf));
}

/// Returns whether light that is sampled behind glass belongs to the background that is hidden there.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool hides_light(const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                         const LightSample<Real>& light, const PathState<Real>& path) {
  return scene.hides_background && path.is_seen_through && !light.is_finite && is_transmitted(point, light.direction) &&
         transmits_sharply(point.bsdf);
}

/// Russian roulette ends paths whose throughput is below this. With a higher threshold more paths end that would have
/// hit a bright surface; a lower one costs more segments than it saves noise (docs/results/quality.md).
inline constexpr double roulette_threshold = 0.25;

/// Continues in a sampled direction. Returns false if the path ends here.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_HOT bool continue_along(const Sampler& sampler, const ShadingPoint<Real>& point,
                                           const BsdfSample<Real>& s, PathState<Real>& path) {
  if (!(s.pdf > 0)) return false;
  path.throughput *= s.weight;
  path.bsdf_pdf = s.pdf;
  path.is_specular = s.specular;
  path.eta_scale *= s.eta * s.eta;
  if (path.is_seen_through) path.is_seen_through = is_seen_through(point, s);
  path.ray = spawn_ray(point.si, s.direction);
  path.travelled = 0;
  const Real survival = max_component(path.throughput) * path.eta_scale * Real(1 / roulette_threshold);
  if (!(survival > 0)) return false;
  if (++path.vertex < 2 || survival >= 1) return true;
  if (sampler.template get_1d<Real>(VertexDimensions(path.vertex - 1).roulette()) >= survival) return false;
  path.throughput *= 1 / survival;
  return true;
}

/// Samples the next ray. Returns false if the path ends here.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_HOT bool continue_path(const Sampler& sampler, const ShadingPoint<Real>& point,
                                          PathState<Real>& path) {
  const BsdfSample<Real> s = scatter(point, sampler, VertexDimensions(path.vertex));
  return continue_along(sampler, point, s, path);
}

/// Records the first hit. Surfaces that are perfectly specular may not count: what is seen in them does, with their
/// colours, and its distance is that from the last of them.
template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT void record_first_hit(const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                             Real distance, PathState<Real>& path, Record& record) {
  if (path.vertex == 0 && record.wants_first_point()) record_first_point(scene, point, record);
  path.awaits_first_hit = scene.records_through_specular && point.bsdf.is_specular();
  if (!record.wants_first_hit() || path.awaits_first_hit) return;
  Vec3<Real> albedo = bsdf_albedo(point.bsdf);
  if (path.vertex > 0) albedo = albedo_in_specular(path, albedo);
  record.keep_first_hit(FirstHit<Real>{albedo, point.si.shading_normal, distance});
}

/// Handles a hit up to direct light: records it and adds emission. Returns false if the path ends there.
template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT bool handle_hit(const SceneView<Real>& scene, uint32_t max_segments, const Hit<Real>& hit,
                                       const ShadingPoint<Real>& point, PathState<Real>& path, Record& record) {
  if (point.material->features & MaterialFeatures::absorbs)
    path.throughput *= beer_lambert(point, path.travelled + hit.t);
  if (path.awaits_first_hit) record_first_hit(scene, point, path.travelled + hit.t, path, record);
  gather_emission(scene, path, hit, point, record);
  return path.vertex + 1 < max_segments;
}

/// Notes how light that was sampled along `wi` at a surface is divided into parts.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_COLD void part_sampled_light(const SceneView<Real>& scene, const Sampler& sampler,
                                                const ShadingPoint<Real>& point, const Vec3<Real>& wi, uint32_t vertex,
                                                PartedLight<Real>& parts) {
  parts.is_at_first = vertex == 0;
  if (scene.light_groups_count > 0)
    parts.sampled_group = light_group(scene, chosen_light(scene, sampler, VertexDimensions(vertex), point).light);
  if (vertex == 0) parts.sampled = {diffuse_fraction(point.bsdf, point.wo, wi), is_transmitted(point, wi)};
}

/// The same for what a path gathers that was scattered at its first surface.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void part_path(const ShadingPoint<Real>& point, const PathState<Real>& path,
                                       PartedLight<Real>& parts) {
  const Vec3<Real>& wi = path.ray.direction;
  parts.path = {path.is_specular ? Vec3<Real>{} : diffuse_fraction(point.bsdf, point.wo, wi),
                is_transmitted(point, wi)};
}

/// Adds direct light and scatters. Returns false if the path ends here. `light` receives the shadow ray to a sampled
/// light and the radiance to add if it is unoccluded; it may trace the ray at once or later.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light>
ALHAZEN_HD ALHAZEN_HOT bool light_and_scatter(const SceneView<Real>& scene, const Sampler& sampler,
                                              const ShadingPoint<Real>& point, PathState<Real>& path, Record& record,
                                              const Light& light) {
  const VertexDimensions dimensions(path.vertex);
  const LightSample<Real> sample = sample_light_for(scene, sampler, dimensions, point);
  DirectLight<Real> direct = direct_light(point, sample);
  if (scene.sees_through_glass && hides_light(scene, point, sample, path)) direct.is_lit = false;
  if constexpr (has_counters<Record>) count_light_sample(scene, sampler, dimensions, point, sample, direct, record);
  if (direct.is_lit) {
    ++record.shadow_rays;
    if (record.parts) part_sampled_light(scene, sampler, point, sample.direction, path.vertex, *record.parts);
    light(direct.shadow, path.throughput * direct.radiance);
  }
  if (samples_by_side(scene)) path.light_side = side_of_light(point);
  const uint32_t vertex = path.vertex;
  const bool goes_on = continue_path(sampler, point, path);
  if (record.parts && vertex == 0 && goes_on) part_path(point, path, *record.parts);
  // The path has one vertex more unless the sample is black.
  if constexpr (has_counters<Record>)
    record.counters.count_bsdf_sample(point.bsdf.kind, path.vertex == vertex, !goes_on && path.vertex > vertex);
  return goes_on;
}

/// Adds emission and direct light and scatters at a hit. Returns false if the path ends there. `light` is as above.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light>
ALHAZEN_HD ALHAZEN_INLINE bool shade(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, PathState<Real>& path, Record& record, const Light& light) {
  if (scene.has_cutouts && passes(scene, hit, ray_kind(path.vertex), path.ray, path.travelled))
    return record.segments < max_transparent_hits;
  const ShadingPoint<Real> point = shading_point(scene, path.ray, hit);
  return handle_hit(scene, max_segments, hit, point, path, record) &&
         light_and_scatter(scene, sampler, point, path, record, light);
}

}  // namespace ALHAZEN_CORE
