#pragma once

// Diffuse surfaces that many paths have met, lit and scattered at side by side: what the path tracer does there has no
// branches that matter, so that compilers turn the loop into SIMD instructions. The functions are those that shade one
// path alone, and so are the bits.

#include "core/integrators/met_surfaces.h"
#include "core/integrators/path.h"
#include "core/sampling/drawn_numbers.h"

namespace ALHAZEN_CORE {

/// Those among `most` surfaces that rays have met; each has the place of its ray.
template <class Real, uint32_t most>
class DiffuseSurfaces {
 public:
  using Met = MetSurfaces<Real, most>;

  /// Takes over the path that is to be lit and to scatter at `point`, which is what `met` has at this place.
  template <class Sampler>
  ALHAZEN_INLINE void add(uint32_t place, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                          const Sampler& sampler, PathState<Real>& path) {
    places_[count_++] = place;
    add_light(place, scene, point, sampler, VertexDimensions(path.vertex));
    if (scene.light_tree_count > 0) path.light_side = side_of_light(point);
    reflectance_.set(place, point.bsdf.a);
    throughput_.set(place, path.throughput);
    eta_scale_[place] = path.eta_scale;
    vertex_[place] = path.vertex;
  }

  uint32_t count() const { return count_; }
  uint32_t place(uint32_t i) const { return places_[i]; }
  void clear() { count_ = triangles_ = skies_ = 0; }

  /// Lights and scatters at all of them, which are among the first `count` places. `numbers` has what is drawn there.
  template <class Numbers>
  void shade(const Met& met, const Numbers& numbers, uint32_t count) {
    const uint32_t end = whole_rows(count);
    if (triangles_ > 0) sample_triangles(met, numbers, end);
    if (skies_ > 0) sample_sky(numbers, end);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const DirectLight<Real> direct = direct_light(point_at(met, i), light_at(i));
      is_lit_[i] = direct.is_lit;
      lit_.set(i, throughput_[i] * direct.radiance);
      shadow_origin_.set(i, direct.shadow.ray.origin);
      shadow_direction_.set(i, direct.shadow.ray.direction);
      shadow_t_max_[i] = direct.shadow.t_max;
    }
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      PathState<Real> path;
      path.throughput = throughput_[i];
      path.eta_scale = eta_scale_[i];
      path.vertex = vertex_[i];
      const Drawn drawn{numbers.pair(dimensions.bsdf_direction(), i), numbers.first(dimensions.roulette(), i)};
      goes_on_[i] = continue_path(drawn, point_at(met, i), path);
      throughput_.set(i, path.throughput);
      bsdf_pdf_[i] = path.bsdf_pdf;
      origin_.set(i, path.ray.origin);
      direction_.set(i, path.ray.direction);
    }
  }

  bool is_lit(uint32_t i) const { return is_lit_[i]; }
  Vec3<Real> lit(uint32_t i) const { return lit_[i]; }
  /// `hit` is where the surface was met.
  ALHAZEN_INLINE ShadowRay<Real> shadow(uint32_t i, const Hit<Real>& hit, Real time) const {
    return {{shadow_origin_[i], shadow_direction_[i], time, hit.primitive, hit.instance}, shadow_t_max_[i]};
  }
  bool goes_on(uint32_t i) const { return goes_on_[i]; }
  ALHAZEN_INLINE void take_over(uint32_t i, const Hit<Real>& hit, PathState<Real>& path) const {
    path.throughput = throughput_[i];
    path.bsdf_pdf = bsdf_pdf_[i];
    path.is_specular = false;
    path.ray.origin = origin_[i];
    path.ray.direction = direction_[i];
    path.ray.left = hit.primitive;
    path.ray.left_instance = hit.instance;
    path.travelled = 0;
    ++path.vertex;
  }

 private:
  /// How a surface comes by its light: it has been sampled, or it is still to be.
  struct LightWay {
    static constexpr uint32_t sampled = 0, triangle = 1, sky = 2;
  };

  /// Stands for the sampler of one path, by the numbers that a diffuse surface asks for.
  struct Drawn {
    Vec2<Real> direction;
    Real roulette;

    template <class>
    ALHAZEN_INLINE Real get_1d(uint32_t) const {
      return roulette;
    }
    template <class>
    ALHAZEN_INLINE Vec2<Real> get_2d(uint32_t) const {
      return direction;
    }
  };

  /// As DrawnNumbers counts them.
  static constexpr VertexDimensions dimensions = VertexDimensions::from(0);

  /// Samples a light for surface i, or sees to it that `sample_lights` does.
  template <class Sampler>
  ALHAZEN_INLINE void add_light(uint32_t i, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                const Sampler& sampler, const VertexDimensions& drawn) {
    light_way_[i] = LightWay::sampled;
    light_pdf_[i] = 0;
    light_is_delta_[i] = light_is_finite_[i] = 0;
    if (scene.lights_count == 0) return;
    const LightChoiceInput<Real> by = light_choice_input(scene, sampler, drawn, point);
    const LightChoice<Real> choice = choose_light(scene, point.si.position, by.normal, by.u);
    if (!(choice.pmf > 0)) return;
    const LightRecord<Real>& light = scene.lights[choice.light];
    light_pmf_[i] = choice.pmf;
    if (light.kind == LightKind::triangle && light.texture.count == 0) {
      const ShiningTriangle<Real>& triangle = scene.shining_triangles[light.shining];
      for (int k = 0; k < 3; ++k) corner_[k].set(i, triangle.corner[k]);
      outward_.set(i, triangle.outward);
      flip_normal_[i] = triangle.flip_normal;
      two_sided_[i] = triangle.two_sided;
      light_radiance_.set(i, triangle.radiance);
      light_way_[i] = LightWay::triangle;
      ++triangles_;
    } else if (light.kind == LightKind::constant_infinite) {
      light_radiance_.set(i, light.radiance);
      light_pdf_[i] = pdf_uniform_sphere<Real> * choice.pmf;
      light_way_[i] = LightWay::sky;
      ++skies_;
    } else {
      set_light(i, sample_chosen_light(scene, light, point.si.position, choice.light == point.light, point.si.time,
                                       sampler.template get_2d<Real>(drawn.light_point())));
      light_pdf_[i] *= choice.pmf;
    }
  }

  /// What `sample_chosen_light` does for the lights that were left to this.
  template <class Numbers>
  void sample_triangles(const Met& met, const Numbers& numbers, uint32_t end) {
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const ShiningTriangle<Real> triangle{{corner_[0][i], corner_[1][i], corner_[2][i]},
                                           outward_[i],
                                           flip_normal_[i],
                                           two_sided_[i],
                                           light_radiance_[i]};
      const LightSample<Real> before = light_at(i);
      const LightSample<Real> s =
          sample_shining_triangle(triangle, met.position(i), numbers.pair(dimensions.light_point(), i));
      const bool takes = light_way_[i] == LightWay::triangle;
      const Real pdf = s.pdf * light_pmf_[i];
      light_direction_.set(i, select(takes, s.direction, before.direction));
      light_radiance_.set(i, select(takes, s.radiance, before.radiance));
      light_point_.set(i, select(takes, s.point, before.point));
      light_point_error_.set(i, select(takes, s.point_error, before.point_error));
      light_normal_.set(i, select(takes, s.normal, before.normal));
      light_pdf_[i] = takes ? pdf : before.pdf;
      light_is_finite_[i] = takes ? s.is_finite : before.is_finite;
    }
  }
  template <class Numbers>
  void sample_sky(const Numbers& numbers, uint32_t end) {
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const bool takes = light_way_[i] == LightWay::sky;
      const Vec3<Real> before = light_direction_[i];
      light_direction_.set(i, select(takes, sample_uniform_sphere(numbers.pair(dimensions.light_point(), i)), before));
    }
  }

  ALHAZEN_INLINE ShadingPoint<Real> point_at(const Met& met, uint32_t i) const {
    ShadingPoint<Real> point = met.bare_point(i);
    point.bsdf.kind = MaterialKind::diffuse;
    point.bsdf.a = reflectance_[i];
    return point;
  }
  ALHAZEN_INLINE void set_light(uint32_t i, const LightSample<Real>& light) {
    light_direction_.set(i, light.direction);
    light_radiance_.set(i, light.radiance);
    light_point_.set(i, light.point);
    light_point_error_.set(i, light.point_error);
    light_normal_.set(i, light.normal);
    light_pdf_[i] = light.pdf;
    light_is_delta_[i] = light.is_delta;
    light_is_finite_[i] = light.is_finite;
  }
  ALHAZEN_INLINE LightSample<Real> light_at(uint32_t i) const {
    LightSample<Real> light;
    light.direction = light_direction_[i];
    light.radiance = light_radiance_[i];
    light.pdf = light_pdf_[i];
    light.is_delta = light_is_delta_[i];
    light.is_finite = light_is_finite_[i];
    light.point = light_point_[i];
    light.point_error = light_point_error_[i];
    light.normal = light_normal_[i];
    return light;
  }

  using Vectors = VectorColumns<Real, most>;
  uint32_t count_ = 0, triangles_ = 0, skies_ = 0;
  uint32_t places_[most]{};
  Vectors reflectance_;
  Vectors light_direction_, light_radiance_, light_point_, light_point_error_, light_normal_;
  Vectors corner_[3], outward_;
  Real light_pdf_[most]{}, light_pmf_[most]{};
  uint32_t light_way_[most]{}, flip_normal_[most]{}, two_sided_[most]{};
  uint32_t light_is_delta_[most]{}, light_is_finite_[most]{};
  Vectors throughput_;
  Real eta_scale_[most]{}, bsdf_pdf_[most]{};
  uint32_t vertex_[most]{}, is_lit_[most]{}, goes_on_[most]{};
  Vectors lit_, shadow_origin_, shadow_direction_, origin_, direction_;
  Real shadow_t_max_[most]{};
};

}  // namespace ALHAZEN_CORE
