#pragma once

// Lights: choosing one by power or by the light tree, sampling a direction towards it, and the density of that sample
// for a ray that hit a light by BSDF sampling. All densities are over solid angle at the reference point. Those of
// `sample_light` and of the functions pdf_... include the probability that the light is chosen; those of
// `sample_chosen_light`, the sample_... functions that it calls and `escaped_light` exclude it.

#include "core/lights/environment.h"
#include "core/lights/light_list.h"
#include "core/lights/light_tree.h"
#include "core/lights/spherical_triangle.h"
#include "core/sampling/discrete.h"
#include "core/sampling/warp.h"
#include "core/shapes/interaction.h"
#include "core/textures/texture.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> emitted_radiance(const Vec3<Real>& radiance, uint32_t two_sided,
                                                   const Vec3<Real>& front_normal, const Vec3<Real>& towards) {
  return select(two_sided || dot(front_normal, towards) > 0, radiance, Vec3<Real>{});
}

/// The texture lookup point of an emissive surface. It is in full detail for every ray, so that light sampling and BSDF
/// sampling see the same emission.
template <class Real>
ALHAZEN_HD TexturePoint<Real> point_of_emission(const SurfaceInteraction<Real>& si, const Hit<Real>& hit) {
  return {si.position, si.uv, {}, hit};
}

/// Factor of the light's texture on its radiance.
template <class Real>
ALHAZEN_HD Vec3<Real> emission_factor(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                      const TexturePoint<Real>& at) {
  return max(evaluate_texture(scene, light.texture, at), Vec3<Real>{});
}

/// The same at a point of a triangle, given the barycentric weights of its second and third vertex.
template <class Real>
ALHAZEN_HD Vec3<Real> triangle_emission_factor(const SceneView<Real>& scene, const LightRecord<Real>& light, Real b1,
                                               Real b2) {
  const Hit<Real> hit{0, b1, b2, PrimitiveId(PrimitiveKind::triangle, light.primitive)};
  return emission_factor(scene, light, point_of_emission(triangle_interaction(scene, hit), hit));
}

/// The same at a point of a sphere.
template <class Real>
ALHAZEN_HD Vec3<Real> sphere_emission_factor(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                             uint32_t frame, const Vec3<Real>& outward, const Vec3<Real>& point) {
  TexturePoint<Real> at{};
  at.position = point;
  if (frame != no_sphere_frame) {
    const SphereFrame<Real>& axes = scene.sphere_frames[frame];
    at.uv = sphere_uv(Vec3<Real>{dot(outward, axes.x), dot(outward, axes.y), dot(outward, axes.z)});
  }
  return emission_factor(scene, light, at);
}

/// Makes a record of SceneView::triangle_emitters.
template <class Real>
ALHAZEN_HD TriangleEmitter<Real> make_triangle_emitter(const SceneView<Real>& scene, const LightRecord<Real>& light) {
  const TriangleRecord& triangle = scene.triangles[light.primitive];
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  const uint32_t* v = triangle.vertex;
  TriangleEmitter<Real> t;
  for (int i = 0; i < 3; ++i) t.corner[i] = scene.positions[v[i]];
  t.outward = mesh_outward(scene, surface, v);
  t.flip_normal = surface.flip_normal;
  t.two_sided = light.two_sided;
  t.radiance = light.radiance;
  t.centre = (t.corner[0] + t.corner[1] + t.corner[2]) * (Real(1) / 3);
  t.near_distance_squared = 0;
  for (int i = 0; i < 3; ++i)
    t.near_distance_squared = max(t.near_distance_squared, 4 * length_squared(t.corner[i] - t.centre));
  return t;
}

/// The sample of the point of a triangle that has these weights of its first two corners, drawn uniformly over the
/// area.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> triangle_light_sample(const TriangleEmitter<Real>& t,
                                                               const Vec3<Real>& reference, const Vec2<Real>& b) {
  LightSample<Real> s;
  const Vec3<Real> q0 = t.corner[0] * b.x;
  const Vec3<Real> q1 = t.corner[1] * b.y;
  const Vec3<Real> q2 = t.corner[2] * (1 - b.x - b.y);
  s.point = q0 + q1 + q2;
  s.point_error = (abs(q0) + abs(q1) + abs(q2)) * rounding_bound<Real>(7);
  const Vec3<Real> winding = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
  s.normal = front_normal(winding, t.outward, t.flip_normal);
  const Vec3<Real> to_light = s.point - reference;
  const Real distance_squared = length_squared(to_light);
  if (!(distance_squared > 0)) return s;
  s.direction = to_light * (1 / std::sqrt(distance_squared));
  const Real cos_area = abs_dot(s.normal, s.direction) * Real(0.5) * length(winding);
  if (!(cos_area > 0)) return s;
  s.pdf = distance_squared / cos_area;
  s.radiance = emitted_radiance(t.radiance, t.two_sided, s.normal, -s.direction);
  s.is_finite = true;
  return s;
}

/// Samples a triangle that is not near.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_far_triangle(const TriangleEmitter<Real>& t,
                                                             const Vec3<Real>& reference, const Vec2<Real>& u) {
  return triangle_light_sample(t, reference, sample_triangle(u));
}

/// Returns whether the triangle is closer to `reference` than about its own size: then its points differ much in what
/// they send there.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool is_near(const TriangleEmitter<Real>& t, const Vec3<Real>& reference) {
  return length_squared(reference - t.centre) < t.near_distance_squared;
}

/// Bounds the length of the edges of a triangle and their distance from a point, up to a factor of 2.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real extent_of(const SphericalTriangle<Real>& t) {
  return max_component(abs(t.to_corner) + abs(t.edge1) + abs(t.edge2));
}

/// Returns whether a near triangle is sampled by the solid angle that it subtends. One seen edge-on is sampled by area.
/// So is one that covers nearly a hemisphere: the point may lie on it, where no light arrives but rounding decides
/// about that. And so is one so large that rounding of its points is not small against the distance from its plane.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool is_sampled_by_solid_angle(const SphericalTriangle<Real>& t) {
  const Vec3<Real> n = cross(t.edge1, t.edge2);
  const bool is_far_from_plane =
      std::abs(dot(t.to_corner, n)) > length(n) * (extent_of(t) * rounding_bound<Real>(2048));
  return is_far_from_plane & (t.solid_angle > Real(1e-3)) & (t.solid_angle < Real(6.2));
}

/// Samples a near triangle. `normal` is as for `choose_light`; `weights` receives those of the first two corners.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_near_triangle(const TriangleEmitter<Real>& t,
                                                              const Vec3<Real>& reference, const Vec3<Real>& normal,
                                                              const Vec2<Real>& u, Vec2<Real>& weights) {
  const SphericalTriangle<Real> seen = spherical_triangle(reference, t.corner[0], t.corner[1], t.corner[2]);
  const bool by_angle = is_sampled_by_solid_angle(seen);
  const BilinearDensity<Real> density = cosine_density(seen, normal);
  const Vec2<Real> place = sample_bilinear(density, u);
  const Vec2<Real> by_solid_angle = sample_spherical_triangle(seen, place), by_area = sample_triangle(u);
  weights = {by_angle ? by_solid_angle.x : by_area.x, by_angle ? by_solid_angle.y : by_area.y};
  LightSample<Real> s = triangle_light_sample(t, reference, weights);
  // Where a ray meets the triangle is uncertain by its size, not by the distance.
  s.point_error += splat(extent_of(seen) * rounding_bound<Real>(8));
  if (by_angle && s.pdf > 0) s.pdf = density.pdf(place) / seen.solid_angle;
  return s;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_triangle_light(const SceneView<Real>& scene,
                                                               const LightRecord<Real>& light,
                                                               const Vec3<Real>& reference, const Vec3<Real>& normal,
                                                               const Vec2<Real>& u) {
  const TriangleEmitter<Real>& t = scene.triangle_emitters[light.emitter];
  Vec2<Real> b = sample_triangle(u);
  LightSample<Real> s =
      is_near(t, reference) ? sample_near_triangle(t, reference, normal, u, b) : triangle_light_sample(t, reference, b);
  if (light.texture.count > 0) s.radiance = s.radiance * triangle_emission_factor(scene, light, b.y, 1 - b.x - b.y);
  return s;
}

/// Density with which `sample_triangle_light` samples the point at `distance` along `ray`, where the unit normal of the
/// triangle is `front`.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real pdf_triangle(const TriangleEmitter<Real>& t, const Ray<Real>& ray, Real distance,
                                         const Vec3<Real>& front, const Vec3<Real>& normal) {
  if (is_near(t, ray.origin)) {
    const SphericalTriangle<Real> seen = spherical_triangle(ray.origin, t.corner[0], t.corner[1], t.corner[2]);
    if (is_sampled_by_solid_angle(seen)) {
      const Vec2<Real> place = invert_spherical_triangle(seen, ray.direction);
      return cosine_density(seen, normal).pdf(place) / seen.solid_angle;
    }
  }
  const Real area = Real(0.5) * length(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
  const Real cos_area = abs_dot(front, ray.direction) * area;
  return cos_area > 0 ? distance * distance / cos_area : Real(0);
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_sphere_light(const SceneView<Real>& scene,
                                                             const LightRecord<Real>& light, const Vec3<Real>& centre,
                                                             Real radius, uint32_t surface, uint32_t frame,
                                                             const Vec3<Real>& reference, bool is_on_light,
                                                             const Vec2<Real>& u) {
  LightSample<Real> s;
  Vec3<Real> outward;
  s.direction = sample_sphere(centre, radius, reference, is_on_light, u, outward, s.pdf);
  s.point = centre + outward * radius;
  s.point_error = (abs(centre) + splat(radius)) * rounding_bound<Real>(8);
  s.normal = scene.surfaces[surface].flip_normal ? -outward : outward;
  s.radiance = emitted_radiance(light.radiance, light.two_sided, s.normal, -s.direction);
  if (light.texture.count > 0) s.radiance = s.radiance * sphere_emission_factor(scene, light, frame, outward, s.point);
  s.is_finite = true;
  return s;
}

/// Chooses one of the lights. `normal` is that of the side of the surface from which light must arrive; zero means
/// any. A light is chosen by an interval of the unit interval, so that stratified numbers stay stratified when they are
/// rescaled.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightChoice<Real> choose_light(const SceneView<Real>& scene, const Vec3<Real>& reference,
                                                      const Vec3<Real>& normal, Real u) {
  const Real by_tree = light_tree_probability(scene, reference, normal);
  if (u < by_tree) {
    LightChoice<Real> choice = sample_light_tree(scene, reference, normal, min(u / by_tree, one_minus_epsilon<Real>));
    choice.pmf *= by_tree;
    return choice;
  }
  u = min((u - by_tree) / (1 - by_tree), one_minus_epsilon<Real>);
  if (scene.lights_count == 1) return {0, scene.lights[0].pmf * (1 - by_tree), u};
  const uint32_t i = sample_cdf(scene.light_cdf, scene.light_cdf_count - 1, u);
  return {i, scene.lights[i].pmf * (1 - by_tree), position_within(scene.light_cdf, i, u)};
}

/// The probability that `choose_light` chooses this light, which is a shape.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real pmf_of_shape(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                         const Vec3<Real>& reference, const Vec3<Real>& normal) {
  if (scene.light_tree_count == 0 || light.pmf == 0) return light.pmf;
  return light_tree_probability(scene, reference, normal) * pmf_of_light_tree(scene, light.trail, reference, normal);
}

/// Samples a point of this light. The density excludes the probability of choosing the light. `normal` is as for
/// `choose_light`. `is_on_light`: `reference` is a point of the light itself.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_chosen_light(const SceneView<Real>& scene,
                                                             const LightRecord<Real>& light,
                                                             const Vec3<Real>& reference, const Vec3<Real>& normal,
                                                             bool is_on_light, Real time, const Vec2<Real>& u) {
  LightSample<Real> s;
  switch (light.kind) {
    case LightKind::triangle:
      s = sample_triangle_light(scene, light, reference, normal, u);
      break;
    case LightKind::sphere: {
      const SphereRecord<Real>& sphere = scene.spheres[light.primitive];
      s = sample_sphere_light(scene, light, sphere.centre, sphere.radius, sphere.surface, sphere.frame, reference,
                              is_on_light, u);
      break;
    }
    case LightKind::moving_sphere: {
      const MovingSphereRecord<Real>& sphere = scene.moving_spheres[light.primitive];
      s = sample_sphere_light(scene, light, sphere.centre + sphere.motion * time, sphere.radius, sphere.surface,
                              sphere.frame, reference, is_on_light, u);
      break;
    }
#define ALHAZEN_CASE(name, Name)                                 \
  case LightKind::name:                                          \
    s = Name##Light::sample(scene, light, reference, normal, u); \
    break;
      ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return s;
}

/// The group of a light, where lights are told apart (SceneView::light_groups).
template <class Real>
ALHAZEN_HD uint32_t light_group(const SceneView<Real>& scene, uint32_t light) {
  return light < scene.light_groups_count ? scene.light_groups[light] : 0;
}

/// Chooses a light and samples a point of it. `normal` is as for `choose_light`; `own_light` is the light that contains
/// `reference`.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT LightSample<Real> sample_light(const SceneView<Real>& scene, const Vec3<Real>& reference,
                                                      const Vec3<Real>& normal, Real time, const Vec2<Real>& u,
                                                      uint32_t own_light = no_light) {
  if (scene.lights_count == 0) return {};
  const LightChoice<Real> choice = choose_light(scene, reference, normal, u.x);
  if (!(choice.pmf > 0)) return {};
  LightSample<Real> s = sample_chosen_light(scene, scene.lights[choice.light], reference, normal,
                                            choice.light == own_light, time, Vec2<Real>{choice.u, u.y});
  s.pdf *= choice.pmf;
  return s;
}

/// Density with which `sample_light`, at the origin of `ray` and with `normal`, samples its direction by the emissive
/// surface that the ray hit.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real pdf_light(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                      const Ray<Real>& ray, const Hit<Real>& hit, const SurfaceInteraction<Real>& si,
                                      const Vec3<Real>& normal) {
  const Real pmf = pmf_of_shape(scene, light, ray.origin, normal);
  const auto of_sphere = [&](const Vec3<Real>& centre, Real radius) {
    const Vec3<Real> outward = scene.surfaces[si.surface].flip_normal ? -si.normal : si.normal;
    return pmf * pdf_sphere(centre, radius, ray.origin, ray.direction, hit.t, outward);
  };
  switch (light.kind) {
    case LightKind::triangle:
      return pmf * pdf_triangle(scene.triangle_emitters[light.emitter], ray, hit.t, si.normal, normal);
    case LightKind::sphere: {
      const SphereRecord<Real>& s = scene.spheres[light.primitive];
      return of_sphere(s.centre, s.radius);
    }
    case LightKind::moving_sphere: {
      const MovingSphereRecord<Real>& s = scene.moving_spheres[light.primitive];
      return of_sphere(s.centre + s.motion * ray.time, s.radius);
    }
    default:
      return 0;
  }
}

/// What a ray that escapes along unit `direction` finds of one of SceneView::far_lights; if `wants_pdf`, with the
/// density of the sample at its start. `normal` is as for `choose_light`.
template <class Real>
ALHAZEN_HD EscapedLight<Real> escaped_light(const SceneView<Real>& scene, const LightRecord<Real>& light,
                                            const Vec3<Real>& normal, const Vec3<Real>& direction, bool wants_pdf) {
  switch (light.kind) {
#define ALHAZEN_CASE(name, Name) \
  case LightKind::name:          \
    return Name##Light::escaped(scene, light, normal, direction, wants_pdf);
    ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
    case LightKind::triangle:
    case LightKind::sphere:
    case LightKind::moving_sphere:
      break;
  }
  return {};
}

/// Radiance of all infinite lights for a ray that escapes along `direction`.
template <class Real>
ALHAZEN_HD Vec3<Real> background_radiance(const SceneView<Real>& scene, const Vec3<Real>& direction) {
  Vec3<Real> radiance = scene.background;
  for (uint32_t i = 0; i < scene.far_lights_count; ++i)
    radiance += escaped_light(scene, scene.lights[scene.far_lights[i]], Vec3<Real>{}, direction, false).radiance;
  return radiance;
}

}  // namespace ALHAZEN_CORE
