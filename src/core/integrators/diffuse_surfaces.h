#pragma once

// Lights and scatters many paths at diffuse surfaces at once. The path tracer has no important branches there, so
// compilers turn the loop into SIMD instructions. It uses the functions that shade a single path, so the bits are the
// same.

#include "core/integrators/hit_points.h"
#include "core/integrators/path.h"
#include "core/sampling/sample_batch.h"

namespace ALHAZEN_CORE {

/// The diffuse hits among up to `max_count` rays; each has the index of its ray.
template <class Real, uint32_t max_count>
class DiffuseSurfaces {
 public:
  using Points = HitPoints<Real, max_count>;

  /// Adds the path that is to be lit and scattered at `point`, which `points` holds at the same index.
  template <class Sampler>
  ALHAZEN_INLINE void add(uint32_t place, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                          const Sampler& sampler, PathState<Real>& path) {
    indices_[count_++] = place;
    add_light(place, scene, point, sampler, VertexDimensions(path.vertex));
    if (scene.light_tree_count > 0) path.light_side = side_of_light(point);
    reflectance_.set(place, point.bsdf.diffuse.reflectance);
    throughput_.set(place, path.throughput);
    eta_scale_[place] = path.eta_scale;
    vertex_[place] = path.vertex;
  }

  uint32_t count() const { return count_; }
  uint32_t place(uint32_t i) const { return indices_[i]; }
  void clear() { count_ = triangles_ = skies_ = 0; }

  /// Lights and scatters all of them; their indices are below `count`. `numbers` holds the random numbers.
  template <class Numbers>
  void shade(const Points& points, const Numbers& numbers, uint32_t count) {
    const uint32_t end = whole_rows(count);
    if (triangles_ > 0) sample_triangles(points, numbers, end);
    if (skies_ > 0) sample_sky(numbers, end);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const DirectLight<Real> direct = direct_light(point_at(points, i), light_at(i));
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
      const StoredSample sample{numbers.pair(dimensions.bsdf_direction(), i), numbers.first(dimensions.roulette(), i)};
      goes_on_[i] = continue_path(sample, point_at(points, i), path);
      throughput_.set(i, path.throughput);
      bsdf_pdf_[i] = path.bsdf_pdf;
      origin_.set(i, path.ray.origin);
      direction_.set(i, path.ray.direction);
    }
  }

  bool is_lit(uint32_t i) const { return is_lit_[i]; }
  Vec3<Real> lit(uint32_t i) const { return lit_[i]; }
  /// `hit` is the hit of the path at index i.
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
  /// How a surface gets its light sample: it has one, or `sample_lights` takes one.
  struct LightSource {
    static constexpr uint32_t sampled = 0, triangle = 1, sky = 2;
  };

  /// Acts as the sampler of one path, with the random numbers that a diffuse surface uses.
  struct StoredSample {
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

  /// Counted as SampleBatch counts them.
  static constexpr VertexDimensions dimensions = VertexDimensions::from(0);

  /// Samples a light for surface i, or defers that to `sample_lights`.
  template <class Sampler>
  ALHAZEN_INLINE void add_light(uint32_t i, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                const Sampler& sampler, const VertexDimensions& path_dimensions) {
    light_source_[i] = LightSource::sampled;
    light_pdf_[i] = 0;
    light_is_delta_[i] = light_is_finite_[i] = 0;
    if (scene.lights_count == 0) return;
    const LightChoiceInput<Real> by = light_choice_input(scene, sampler, path_dimensions, point);
    const LightChoice<Real> choice = choose_light(scene, point.si.position, by.normal, by.u);
    if (!(choice.pmf > 0)) return;
    const LightRecord<Real>& light = scene.lights[choice.light];
    light_pmf_[i] = choice.pmf;
    if (light.kind == LightKind::triangle && light.texture.count == 0) {
      const TriangleEmitter<Real>& triangle = scene.triangle_emitters[light.emitter];
      for (int k = 0; k < 3; ++k) corner_[k].set(i, triangle.corner[k]);
      outward_.set(i, triangle.outward);
      flip_normal_[i] = triangle.flip_normal;
      two_sided_[i] = triangle.two_sided;
      light_radiance_.set(i, triangle.radiance);
      light_source_[i] = LightSource::triangle;
      ++triangles_;
    } else if (light.kind == LightKind::constant_infinite) {
      light_radiance_.set(i, light.radiance);
      light_pdf_[i] = pdf_uniform_sphere<Real> * choice.pmf;
      light_source_[i] = LightSource::sky;
      ++skies_;
    } else {
      set_light(i, sample_chosen_light(scene, light, point.si.position, choice.light == point.light, point.si.time,
                                       sampler.template get_2d<Real>(path_dimensions.light_point())));
      light_pdf_[i] *= choice.pmf;
    }
  }

  /// Does what `sample_chosen_light` does for the deferred lights.
  template <class Numbers>
  void sample_triangles(const Points& points, const Numbers& numbers, uint32_t end) {
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const TriangleEmitter<Real> triangle{{corner_[0][i], corner_[1][i], corner_[2][i]},
                                           outward_[i],
                                           flip_normal_[i],
                                           two_sided_[i],
                                           light_radiance_[i]};
      const LightSample<Real> before = light_at(i);
      const LightSample<Real> s =
          sample_triangle_emitter(triangle, points.position(i), numbers.pair(dimensions.light_point(), i));
      const bool takes = light_source_[i] == LightSource::triangle;
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
      const bool takes = light_source_[i] == LightSource::sky;
      const Vec3<Real> before = light_direction_[i];
      light_direction_.set(i, select(takes, sample_uniform_sphere(numbers.pair(dimensions.light_point(), i)), before));
    }
  }

  ALHAZEN_INLINE ShadingPoint<Real> point_at(const Points& points, uint32_t i) const {
    ShadingPoint<Real> point = points.bare_point(i);
    point.bsdf.kind = MaterialKind::diffuse;
    point.bsdf.diffuse.reflectance = reflectance_[i];
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

  using Vectors = VectorColumns<Real, max_count>;
  uint32_t count_ = 0, triangles_ = 0, skies_ = 0;
  uint32_t indices_[max_count]{};
  Vectors reflectance_;
  Vectors light_direction_, light_radiance_, light_point_, light_point_error_, light_normal_;
  Vectors corner_[3], outward_;
  Real light_pdf_[max_count]{}, light_pmf_[max_count]{};
  uint32_t light_source_[max_count]{}, flip_normal_[max_count]{}, two_sided_[max_count]{};
  uint32_t light_is_delta_[max_count]{}, light_is_finite_[max_count]{};
  Vectors throughput_;
  Real eta_scale_[max_count]{}, bsdf_pdf_[max_count]{};
  uint32_t vertex_[max_count]{}, is_lit_[max_count]{}, goes_on_[max_count]{};
  Vectors lit_, shadow_origin_, shadow_direction_, origin_, direction_;
  Real shadow_t_max_[max_count]{};
};

}  // namespace ALHAZEN_CORE
