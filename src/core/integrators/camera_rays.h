#pragma once

// Generates the camera rays of many samples in structure-of-arrays form, with the same bits as `sample_camera` does for
// one.

#include "core/integrators/camera_sample.h"
#include "core/sampling/sample_batch.h"
#include "core/simd/columns.h"

namespace ALHAZEN_CORE {

/// Sample number `sample` of pixel (x, y).
struct PixelSample {
  uint32_t x, y, sample;
};

/// Camera rays of up to `max_count` samples.
template <class Real, class Sampler, uint32_t max_count>
class CameraRays {
 public:
  /// Generates `count` rays; `pixel(i)` returns the pixel and sample number of sample i.
  template <class Pixel>
  void make(const SceneView<Real>& scene, uint32_t seed, uint32_t count, const Pixel& pixel) {
    for (uint32_t i = 0; i < count; ++i) {
      const PixelSample sample = pixel(i);
      x_[i] = sample.x;
      y_[i] = sample.y;
      sample_[i] = sample.sample;
    }
    const uint32_t end = whole_rows(count);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) numbers_.samplers[i] = Sampler(seed, x_[i], y_[i], sample_[i]);
    numbers_.draw(count, wanted_numbers(scene));
    set_film_positions(scene, end);
    make_rays(scene.camera, end);
  }

  const Sampler& sampler(uint32_t i) const { return numbers_.samplers[i]; }
  Vec3<Real> origin(uint32_t i) const { return origin_[i]; }
  Vec3<Real> direction(uint32_t i) const { return direction_[i]; }
  Real time(const SceneView<Real>& scene, uint32_t i) const {
    return scene_moves(scene) ? numbers_.first(CameraDimensions::time, i) : Real(0);
  }
  Real filter_weight(uint32_t i) const { return filter_weight_[i]; }

 private:
  static uint32_t wanted_numbers(const SceneView<Real>& scene) {
    return 1u << CameraDimensions::film | (scene.camera.lens_radius > 0 ? 1u << CameraDimensions::lens : 0) |
           (scene_moves(scene) ? 1u << CameraDimensions::time : 0);
  }

  void set_film_positions(const SceneView<Real>& scene, uint32_t end) {
    const auto place = [&](uint32_t i, const FilterSample<Real>& filter) {
      const FilmSample<Real> film = film_sample(x_[i], y_[i], filter);
      film_x_[i] = film.position.x;
      film_y_[i] = film.position.y;
      filter_weight_[i] = film.filter_weight;
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
      const Ray<Real> ray = camera_ray(camera, Vec2<Real>{film_x_[i], film_y_[i]}, lens, Real(0));
      origin_.set(i, ray.origin);
      direction_.set(i, ray.direction);
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

  uint32_t x_[max_count]{}, y_[max_count]{}, sample_[max_count]{};
  SampleBatch<Real, Sampler, max_count, CameraDimensions> numbers_;
  uint32_t cell_x_[max_count], cell_y_[max_count];
  Real film_x_[max_count], film_y_[max_count], filter_weight_[max_count];
  VectorColumns<Real, max_count> origin_, direction_;
};

}  // namespace ALHAZEN_CORE
