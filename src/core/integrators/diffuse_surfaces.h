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
  template <SamplerOf<Real> Sampler>
  ALHAZEN_INLINE void add(uint32_t place, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                          const Sampler& sampler, PathState<Real>& path) {
    indices_[count_++] = place;
    add_light(place, scene, point, sampler, VertexDimensions(path.vertex));
    if (samples_by_side(scene)) path.light_side = side_of_light(point);
    reflectance_.set(place, point.bsdf.diffuse.reflectance);
    paths_.set(place, path);
  }

  uint32_t count() const { return count_; }
  /// The light that surface i samples, if there is a choice.
  uint32_t light(uint32_t i) const { return chosen_lights_[i]; }
  uint32_t place(uint32_t i) const { return indices_[i]; }
  void clear() { count_ = triangles_ = near_count_ = 0; }

  /// Lights and scatters all of them; their indices are below `count`. `numbers` holds the random numbers.
  template <SampleBatchOf<Real> Numbers>
  void shade(const Points& points, const Numbers& numbers, uint32_t count) {
    const uint32_t end = whole_rows(count);
    if (triangles_ > 0) sample_triangles(points, end);
    if (near_count_ > 0) sample_near_triangles();
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const DirectLight<Real> direct = direct_light(point_at(points, i), lights_[i]);
      is_lit_[i] = direct.is_lit;
      direct_radiance_.set(i, paths_[i].throughput * direct.radiance);
      shadow_rays_.set(i, direct.shadow.ray);
      shadow_limits_[i] = direct.shadow.t_max;
    }
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      PathState<Real> path = paths_[i];
      const StoredSample sample{numbers.pair(dimensions.bsdf_direction(), i), numbers.first(dimensions.roulette(), i)};
      goes_on_[i] = continue_path(sample, point_at(points, i), path);
      continued_.set(i, path);
      next_rays_.set(i, path.ray);
    }
  }

  /// The light that reaches surface i, the path's throughput included. `hit` and `time` are those of the path's ray.
  ALHAZEN_INLINE DirectLight<Real> direct(uint32_t i, const Hit<Real>& hit, Real time) const {
    DirectLight<Real> direct;
    direct.is_lit = is_lit_[i] != 0;
    direct.radiance = direct_radiance_[i];
    direct.shadow = {shadow_rays_[i], shadow_limits_[i]};
    set_departure(hit, time, direct.shadow.ray);
    return direct;
  }
  bool goes_on(uint32_t i) const { return goes_on_[i]; }
  ALHAZEN_INLINE void take_over(uint32_t i, const Hit<Real>& hit, PathState<Real>& path) const {
    const Real time = path.ray.time;
    continued_.get(i, path);
    next_rays_.get(i, path.ray);
    set_departure(hit, time, path.ray);
    path.is_specular = path.is_seen_through = false;
    path.travelled = 0;
    ++path.vertex;
  }

 private:
  /// How a surface gets its light sample: it has one, or `shade` takes one.
  struct LightSource {
    static constexpr uint32_t sampled = 0, triangle = 1;
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

  /// Sets what the stored ray lacks: the time, and the surface that it leaves.
  ALHAZEN_INLINE static void set_departure(const Hit<Real>& hit, Real time, Ray<Real>& ray) {
    ray.time = time;
    ray.left = hit.primitive;
    ray.left_instance = hit.instance;
  }

  /// Samples a light for surface i, or defers that to `shade`.
  template <SamplerOf<Real> Sampler>
  ALHAZEN_INLINE void add_light(uint32_t i, const SceneView<Real>& scene, const ShadingPoint<Real>& point,
                                const Sampler& sampler, const VertexDimensions& path_dimensions) {
    light_source_[i] = LightSource::sampled;
    lights_.template set_only<&Light::pdf, &Light::is_delta, &Light::is_finite>(i, {});
    if (scene.lights_count == 0) return;
    Vec2<Real> u = sampler.template get_2d<Real>(path_dimensions.light());
    const Vec3<Real> side_for_tree = scene.light_tree_count > 0 ? side_of_light(point) : Vec3<Real>{};
    const LightChoice<Real> choice = choose_light(scene, point.si.position, side_for_tree, u.x);
    if (!(choice.pmf > 0)) return;
    u.x = choice.u;
    const LightRecord<Real>& light = scene.lights[choice.light];
    light_pmf_[i] = choice.pmf;
    chosen_lights_[i] = choice.light;
    if (light.kind == LightKind::triangle && light.texture.count == 0) {
      const TriangleEmitter<Real>& triangle = scene.triangle_emitters[light.emitter];
      if (is_near(triangle, point.si.position)) {
        near_.add(near_count_++, i, triangle, point.si.position, side_of_light(point), u);
        return;
      }
      emitters_.set(i, triangle);
      light_u_.set(i, u);
      light_source_[i] = LightSource::triangle;
      ++triangles_;
    } else {
      Light sampled = sample_chosen_light(scene, light, point.si.position, side_of_light(point),
                                          choice.light == point.light, point.si.time, u);
      sampled.pdf *= choice.pmf;
      lights_.set(i, sampled);
    }
  }

  /// Does what `sample_chosen_light` does for the deferred lights.
  void sample_triangles(const Points& points, uint32_t end) {
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      Light sampled = sample_far_triangle(emitters_[i], points.position(i), light_u_[i]);
      sampled.pdf *= light_pmf_[i];
      lights_.set(i, select(light_source_[i] == LightSource::triangle, sampled, lights_[i]));
    }
  }

  /// The same for near triangles, which are stored one after the other.
  void sample_near_triangles() {
    const uint32_t end = whole_rows(near_count_);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t k = 0; k < end; ++k) {
      Vec2<Real> weights;
      near_.samples.set(
          k, sample_near_triangle(near_.emitters[k], near_.references[k], near_.sides[k], near_.u[k], weights));
    }
    for (uint32_t k = 0; k < near_count_; ++k) {
      const uint32_t i = near_.indices[k];
      Light sampled = near_.samples[k];
      sampled.pdf *= light_pmf_[i];
      lights_.set(i, sampled);
    }
  }

  ALHAZEN_INLINE ShadingPoint<Real> point_at(const Points& points, uint32_t i) const {
    ShadingPoint<Real> point = points.bare_point(i);
    point.bsdf.kind = MaterialKind::diffuse;
    point.bsdf.diffuse.reflectance = reflectance_[i];
    return point;
  }

  using Light = LightSample<Real>;
  using Path = PathState<Real>;
  /// The time of these rays, and the surface that they leave, are those of the hit.
  using RayArrays = SoA<Ray<Real>, max_count, FieldList<&Ray<Real>::origin, &Ray<Real>::direction>>;
  uint32_t count_ = 0, triangles_ = 0;
  uint32_t indices_[max_count]{};
  SoA<Vec3<Real>, max_count> reflectance_;
  /// Near triangles that are still to be sampled, and the surfaces that they light.
  struct NearTriangles {
    uint32_t indices[max_count]{};
    SoA<TriangleEmitter<Real>, max_count> emitters;
    SoA<Vec3<Real>, max_count> references, sides;
    SoA<Vec2<Real>, max_count> u;
    SoA<Light, max_count> samples;

    ALHAZEN_INLINE void add(uint32_t k, uint32_t index, const TriangleEmitter<Real>& emitter,
                            const Vec3<Real>& reference, const Vec3<Real>& side, const Vec2<Real>& numbers) {
      indices[k] = index;
      emitters.set(k, emitter);
      references.set(k, reference);
      sides.set(k, side);
      u.set(k, numbers);
    }
  };
  NearTriangles near_;
  uint32_t near_count_ = 0;
  uint32_t light_source_[max_count]{};
  Real light_pmf_[max_count]{};
  uint32_t chosen_lights_[max_count]{};
  SoA<Vec2<Real>, max_count> light_u_;              ///< the random numbers that sample them
  SoA<TriangleEmitter<Real>, max_count> emitters_;  ///< of lights that are still to be sampled
  SoA<Light, max_count> lights_;
  uint32_t is_lit_[max_count]{};
  SoA<Vec3<Real>, max_count> direct_radiance_;
  RayArrays shadow_rays_;
  Real shadow_limits_[max_count]{};
  SoA<Path, max_count, FieldList<&Path::throughput, &Path::eta_scale, &Path::vertex>> paths_;
  SoA<Path, max_count, FieldList<&Path::throughput, &Path::bsdf_pdf>> continued_;
  RayArrays next_rays_;
  uint32_t goes_on_[max_count]{};
};

}  // namespace ALHAZEN_CORE
