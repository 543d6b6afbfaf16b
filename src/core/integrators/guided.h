#pragma once

// Scattering by what path guiding has learned: a direction comes from the BSDF or from the tree of directions of the
// region, with the density of both together (one-sample MIS; Veach 1997, section 9.2.4). The BSDF's share is learned
// for each region.

#include <type_traits>

#include "core/guiding/guide.h"
#include "core/integrators/integrator_kind.h"
#include "core/integrators/path.h"

namespace ALHAZEN_CORE {

/// What paths keep besides their state: with guiding their vertices, else nothing.
template <class Real>
struct NoTrail {
  ALHAZEN_HD void begin() {}
  ALHAZEN_HD ALHAZEN_HOT void start_segment(Real) {}
};
template <IntegratorKind kind, class Real>
using TrailOf = std::conditional_t<kind == IntegratorKind::guided_path, GuideTrail<Real>, NoTrail<Real>>;

template <class Real>
ALHAZEN_HD void learn_from_path(const SceneView<Real>&, const NoTrail<Real>&, const Vec3<Real>&) {}

/// Called when a path has ended, with the radiance that it gathered.
template <class Real>
ALHAZEN_HD void learn_from_path(const SceneView<Real>& scene, const GuideTrail<Real>& trail,
                                const Vec3<Real>& radiance) {
  if (!(scene.guide.to_fixed > 0)) return;
  const Real total = luminance(radiance);
  for (uint32_t i = 0; i < trail.count; ++i) {
    const GuideVertex<Real>& vertex = trail.vertices[i];
    learn_from_vertex(scene.guide, vertex, total - max(vertex.radiance, Real(0)),
                      combine32(bits_of(vertex.square.x), bits_of(vertex.position.x)));
  }
}

template <class Real>
ALHAZEN_HD uint32_t region_at(const SceneView<Real>& scene, const Vec3<Real>& position) {
  uint32_t depth;
  return guide_region(scene.guide, guide_place(scene.guide, position), depth);
}

/// The distribution of directions at a surface.
template <class Real>
struct GuidedDirections {
  uint32_t number;  ///< of the region
  uint32_t quad;    ///< root of its tree of directions
  Real bsdf_share;  ///< 1 where the BSDF alone is sampled

  ALHAZEN_HD GuidedDirections(const SceneView<Real>& scene, uint32_t region_number) : number(region_number) {
    const GuideRegion& region = scene.guide.regions[number];
    quad = region.quad;
    bsdf_share = static_cast<Real>(region.bsdf_share);
  }

  /// Density of the tree, with respect to solid angle.
  ALHAZEN_HD Real pdf_of_guide(const SceneView<Real>& scene, const Vec3<Real>& direction,
                               const Vec2<Real>& square) const {
    return guide_pdf(scene.guide, quad, square) * guide_density(direction);
  }
  ALHAZEN_HD Real mixed(Real pdf_of_bsdf, Real pdf_of_guide) const {
    return bsdf_share * pdf_of_bsdf + (1 - bsdf_share) * pdf_of_guide;
  }
};

/// Samples a direction. `vertex` receives what is learned from it; its throughput is 0 for what is not learned from.
template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD BsdfSample<Real> scatter_guided(const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                           const GuidedDirections<Real>& directions, const Sampler& sampler,
                                           const VertexDimensions& dimensions, GuideVertex<Real>& vertex) {
  // Which of both is sampled is decided by a number of the direction: what it leaves of the points is as well
  // distributed as all of them.
  Vec2<Real> u = sampler.template get_2d<Real>(dimensions.bsdf_direction());
  const Real share = directions.bsdf_share;
  const bool by_bsdf = u.x < share;
  u.x = min(by_bsdf ? u.x / share : (u.x - share) / (1 - share), one_minus_epsilon<Real>);
  BsdfSample<Real> s;
  if (by_bsdf) {
    const bool has_lobes = has_trait<&MaterialTraits::has_lobes>(point.bsdf.kind);
    const Real u_lobe = has_lobes ? sampler.template get_1d<Real>(dimensions.bsdf_lobe()) : Real(0);
    s = sample_bsdf(point.bsdf, point.wo, u_lobe, u);
    if (!(s.pdf > 0)) return s;
    if (s.specular) {
      s.weight *= 1 / share;
      vertex.throughput = 0;
      if (!is_on_one_side(point, s.direction)) s.pdf = 0;
      return s;
    }
    vertex.square = guide_square(s.direction);
    vertex.pdf_of_bsdf = s.pdf;
    vertex.pdf_of_guide = directions.pdf_of_guide(scene, s.direction, vertex.square);
    s.pdf = directions.mixed(vertex.pdf_of_bsdf, vertex.pdf_of_guide);
    s.weight *= vertex.pdf_of_bsdf / s.pdf;
  } else {
    const GuideSample<Real> sampled = sample_guide(scene.guide, directions.quad, u);
    const GuideDirection<Real> there = guide_direction(sampled.square);
    s.direction = there.direction;
    const BsdfValue<Real> f = evaluate_bsdf(point.bsdf, point.wo, s.direction);
    if (is_zero(f.value)) return s;
    vertex.square = sampled.square;
    vertex.pdf_of_bsdf = f.pdf;
    vertex.pdf_of_guide = sampled.pdf * there.density;
    s.pdf = directions.mixed(vertex.pdf_of_bsdf, vertex.pdf_of_guide);
    if (!(s.pdf > 0 && s.pdf < infinity<Real>)) {
      s.pdf = 0;
      return s;
    }
    s.weight = f.value * (1 / s.pdf);
  }
  if (!is_on_one_side(point, s.direction)) s.pdf = 0;
  return s;
}

/// Does what `light_and_scatter` of path.h does, with guiding, in a region of the guide.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light>
ALHAZEN_HD bool light_and_scatter(const SceneView<Real>& scene, const Sampler& sampler, const ShadingPoint<Real>& point,
                                  PathState<Real>& path, Record& record, const Light& light, GuideTrail<Real>& trail,
                                  uint32_t region) {
  const VertexDimensions dimensions(path.vertex);
  const GuidedDirections<Real> directions(scene, region);
  const LightSample<Real> sample = sample_light_for(scene, sampler, dimensions, point);
  DirectLight<Real> direct = direct_light(point, sample, [&](Real pdf_of_bsdf) {
    return directions.mixed(pdf_of_bsdf,
                            directions.pdf_of_guide(scene, sample.direction, guide_square(sample.direction)));
  });
  if (scene.sees_through_glass && hides_light(scene, point, sample, path)) direct.is_lit = false;
  if (direct.is_lit) {
    ++record.shadow_rays;
    if (record.parts) part_sampled_light(scene, sampler, point, sample.direction, path.vertex, *record.parts);
    light(direct.shadow, path.throughput * direct.radiance);
  }
  const bool is_first = path.vertex == 0;
  if (samples_by_side(scene)) path.light_side = side_of_light(point);
  GuideVertex<Real> vertex;
  vertex.throughput = luminance(path.throughput);
  const BsdfSample<Real> s = scatter_guided(scene, point, directions, sampler, dimensions, vertex);
  // Roulette is played as if the BSDF alone had been sampled: what guiding makes likely has a small weight and is worth
  // following.
  if (s.pdf > 0)
    path.eta_scale *= s.specular               ? directions.bsdf_share
                      : vertex.pdf_of_bsdf > 0 ? min(s.pdf / vertex.pdf_of_bsdf, Real(1e6))
                                               : Real(1e6);
  if (!continue_along(sampler, point, s, path)) return false;
  if (record.parts && is_first) part_path(point, path, *record.parts);
  if (vertex.throughput > 0 && trail.count < GuideTrail<Real>::max_vertices) {
    vertex.position = point.si.position;
    vertex.radiance = -1;
    vertex.region = directions.number;
    vertex.share = directions.bsdf_share;
    trail.vertices[trail.count++] = vertex;
  }
  return true;
}

template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light>
ALHAZEN_HD bool light_and_scatter(const SceneView<Real>& scene, const Sampler& sampler, const ShadingPoint<Real>& point,
                                  PathState<Real>& path, Record& record, const Light& light, GuideTrail<Real>& trail) {
  if (point.bsdf.is_specular()) return light_and_scatter(scene, sampler, point, path, record, light);
  return light_and_scatter(scene, sampler, point, path, record, light, trail, region_at(scene, point.si.position));
}

template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light>
ALHAZEN_HD ALHAZEN_INLINE bool light_and_scatter(const SceneView<Real>& scene, const Sampler& sampler,
                                                 const ShadingPoint<Real>& point, PathState<Real>& path, Record& record,
                                                 const Light& light, NoTrail<Real>&) {
  return light_and_scatter(scene, sampler, point, path, record, light);
}

/// Adds emission and direct light and scatters at a hit. Returns false if the path ends there.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light, class Trail>
ALHAZEN_HD ALHAZEN_INLINE bool shade(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, PathState<Real>& path, Record& record, const Light& light,
                                     Trail& trail) {
  if (scene.has_cutouts && passes(scene, hit, ray_kind(path.vertex), path.ray, path.travelled))
    return record.segments < max_transparent_hits;
  const ShadingPoint<Real> point = shading_point(scene, path.ray, hit);
  return handle_hit(scene, max_segments, hit, point, path, record) &&
         light_and_scatter(scene, sampler, point, path, record, light, trail);
}

}  // namespace ALHAZEN_CORE
