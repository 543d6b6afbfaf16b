#pragma once

// Generates the camera rays of many samples in structure-of-arrays form, with the same bits as `sample_camera` does for
// one.

#include "core/integrators/camera_sample.h"
#include "core/math/field_list.h"
#include "core/sampling/sample_batch.h"
#include "core/simd/soa.h"

namespace ALHAZEN_CORE {

/// Sample number `sample` of pixel (x, y).
struct PixelSample {
  uint32_t x, y, sample;

  using Fields = FieldList<&PixelSample::x, &PixelSample::y, &PixelSample::sample>;
};

/// Returns the pixel and sample number of sample i.
template <class Pixel>
concept PixelLookup = std::is_invocable_r_v<PixelSample, const Pixel&, uint32_t>;

/// Camera rays of up to `max_count` samples.
template <class Real, SamplerOf<Real> Sampler, uint32_t max_count>
class CameraRays {
 public:
  /// Generates `count` rays.
  template <PixelLookup Pixel>
  void make(const SceneView<Real>& scene, SampleSeed seed, uint32_t count, const Pixel& pixel) {
    for (uint32_t i = 0; i < count; ++i) pixels_.set(i, pixel(i));
    const uint32_t end = whole_rows(count);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      const PixelSample sample = pixels_[i];
      numbers_.samplers[i] = Sampler(seed, sample.x, sample.y, sample.sample);
    }
    numbers_.draw(count, wanted_numbers(scene));
    set_film_positions(scene, end);
    make_rays(scene.camera, end);
  }

  const Sampler& sampler(uint32_t i) const { return numbers_.samplers[i]; }
  Ray<Real> ray(const SceneView<Real>& scene, uint32_t i) const {
    Ray<Real> ray = rays_[i];
    if (scene_moves(scene)) ray.time = numbers_.first(CameraDimensions::time, i);
    return ray;
  }
  Real filter_weight(uint32_t i) const { return film_[i].filter_weight; }

 private:
  static uint32_t wanted_numbers(const SceneView<Real>& scene) {
    return 1u << CameraDimensions::film | (scene.camera.lens_radius > 0 ? 1u << CameraDimensions::lens : 0) |
           (scene_moves(scene) ? 1u << CameraDimensions::time : 0);
  }

  void set_film_positions(const SceneView<Real>& scene, uint32_t end) {
    const auto place = [&](uint32_t i, const FilterSample<Real>& filter) {
      const PixelSample pixel = pixels_[i];
      film_.set(i, film_sample(pixel.x, pixel.y, filter));
    };
    const auto u = [&](uint32_t i) { return numbers_.pair(CameraDimensions::film, i); };
    const FilterRecord<Real> filter = scene.filter;
    if (filter.cells == 0) {
      ALHAZEN_SIDE_BY_SIDE
      for (uint32_t i = 0; i < end; ++i) place(i, sample_box(filter, u(i)));
      return;
    }
    const FilterAxis<Real> x = filter_x(filter, scene.filter_cdf), y = filter_y(filter, scene.filter_cdf);
    const auto next = [](const FilterAxis<Real>& axis, uint32_t cell, Real at) {
      return cell + (axis.is_after(cell, at) ? 1 : 0);
    };
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      cell_x_[i] = next(x, x.guess(u(i).x), u(i).x);
      cell_y_[i] = next(y, y.guess(u(i).y), u(i).y);
    }
    // In most cases the guess is the cell.
    for (uint32_t i = 0; i < end; ++i) {
      cell_x_[i] = x.find(cell_x_[i], u(i).x);
      cell_y_[i] = y.find(cell_y_[i], u(i).y);
    }
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) place(i, sample_cells(x, y, cell_x_[i], cell_y_[i], u(i)));
  }

  /// Does what `camera_ray` does with the film positions, in SIMD loops if the camera is a perspective one.
  void make_rays(CameraRecord<Real> camera, uint32_t end) {
    const auto make = [&](const Vec2<Real>& lens, uint32_t i) {
      rays_.set(i, camera_ray(camera, film_[i].position, lens, Real(0)));
    };
    const auto lens = [&](uint32_t i) { return numbers_.pair(CameraDimensions::lens, i); };
    const bool has_lens = camera.lens_radius > 0;
    if (camera.kind != CameraKind::perspective) {
      for (uint32_t i = 0; i < end; ++i) make(has_lens ? lens(i) : Vec2<Real>{}, i);
      return;
    }
    // The assignments tell the compiler the results of the branches.
    camera.kind = CameraKind::perspective;
    if (has_lens) {
      ALHAZEN_SIDE_BY_SIDE
      for (uint32_t i = 0; i < end; ++i) make(lens(i), i);
    } else {
      camera.lens_radius = 0;
      ALHAZEN_SIDE_BY_SIDE
      for (uint32_t i = 0; i < end; ++i) make({}, i);
    }
  }

  SoA<PixelSample, max_count> pixels_;
  SampleBatch<Real, Sampler, max_count, CameraDimensions> numbers_;
  uint32_t cell_x_[max_count], cell_y_[max_count];  ///< of the filter
  SoA<FilmSample<Real>, max_count> film_;
  SoA<Ray<Real>, max_count, FieldList<&Ray<Real>::origin, &Ray<Real>::direction>> rays_;
};

}  // namespace ALHAZEN_CORE
