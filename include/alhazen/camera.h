#pragma once

// The camera, the film, and how a scene is rendered where settings leave that open.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "alhazen/geometry.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

enum class CameraKind {
  perspective,
  orthographic,     ///< rays are parallel to z
  equirectangular,  ///< the whole sphere of directions; the camera's y is up
  equal_area,       ///< the whole sphere by the octahedral mapping
};

/// What is out of these ranges, Scene::set_camera refuses.
struct Camera {
  CameraKind kind = CameraKind::perspective;
  /// From camera space (x right, y up, z into the scene) to world space: Transform::look_at.
  MovingTransform transform{};
  double fov = 90;  ///< perspective: degrees over the shorter side of the image, over 0 and under 180
  /// x0, x1, y0, y1 of what is seen, of orthographic cameras in camera space, of perspective ones relative to `fov`;
  /// with an area; absent: [-1, 1] over the shorter side.
  std::optional<std::array<double, 4>> screen_window{};
  std::optional<double> frame_aspect_ratio{};  ///< over 0; absent: that of the image
  double lens_radius = 0;                      ///< camera space, not negative; 0: all is sharp
  double focal_distance = 1e6;                 ///< camera space, over 0: of what is sharp, if the lens has a radius
  double shutter_open = 0, shutter_close = 1;  ///< in this order: times of the motion that is seen
};

/// The image. It has fewer than 10^9 pixels.
struct Film {
  int64_t width = 1280, height = 720;                    ///< pixels, each from 1 to 100000
  std::optional<std::array<int64_t, 4>> pixel_bounds{};  ///< x0, x1, y0, y1 of what is rendered, half open; absent: all
  double exposure = 1;                                   ///< factor on the radiance, over 0
};

enum class FilterKind { box, triangle, gaussian, mitchell, sinc };

/// How samples around a pixel are weighted.
struct PixelFilter {
  FilterKind kind = FilterKind::gaussian;
  double x_radius = 1.5, y_radius = 1.5;  ///< pixels, over 0 and at most 64
  double sigma = 0.5;                     ///< gaussian: standard deviation in pixels, over 0
  double b = 1.0 / 3, c = 1.0 / 3;        ///< mitchell
  double tau = 3;                         ///< sinc, over 0
};

enum class Integrator { path, iterative, recursive, branching };
enum class Sampler { sobol, zsobol, independent };

/// Used where Settings leave them open. These are the defaults of new scenes; files have those of their format.
struct RenderDefaults {
  int64_t samples_per_pixel = 64;  ///< from 1 on
  uint32_t seed = 0;
  int64_t max_depth = 8;  ///< bounces, from 0 on
  Integrator integrator = Integrator::path;
  Sampler sampler = Sampler::sobol;
  std::string quality = "good";  ///< draft, good, final; empty: none (docs/noise.md)
  bool pbrt_coats = false;       ///< coated materials lose as much light as pbrt-v4's
};

}  // namespace ALHAZEN_NAMESPACE
