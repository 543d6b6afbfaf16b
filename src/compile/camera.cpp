#include "compile/camera.h"

#include <cmath>
#include <numbers>

#include "scene/filters.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t filter_cells = 128;

double sinc(double x) { return std::abs(x) < 1e-9 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

/// Mitchell and Netravali 1988, for a filter of support 2.
double mitchell(double x, double b, double c) {
  x = std::abs(x);
  if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x < 2)
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
  return 0;
}

double gaussian(double x, double sigma) { return std::exp(-x * x / (2 * sigma * sigma)); }

/// Appends the table of one axis, in the layout of core/cameras/filter.h.
template <class Real>
bool add_filter_axis(const Filter& filter, double radius, std::vector<Real>& table) {
  std::vector<double> cells(filter_cells);
  constexpr int points = 16;
  double total = 0;
  for (uint32_t i = 0; i < filter_cells; ++i) {
    for (int k = 0; k < points; ++k)
      cells[i] += filter_value(filter, radius * (2 * (i + (k + 0.5) / points) / filter_cells - 1), radius) / points;
    total += std::abs(cells[i]);
  }
  if (!(total > 0) || !std::isfinite(total)) throw InputError("the pixel filter is zero everywhere");
  double sum = 0;
  table.push_back(0);
  for (uint32_t i = 0; i < filter_cells; ++i) {
    sum += std::abs(cells[i]);
    table.push_back(i + 1 == filter_cells ? Real(1) : static_cast<Real>(sum / total));
  }
  bool negative = false;
  for (const double cell : cells) {
    table.push_back(cell < 0 ? Real(-1) : Real(1));
    negative = negative || cell < 0;
  }
  const size_t cdf = table.size() - 2 * filter_cells - 1;
  uint32_t cell = 0;
  constexpr uint32_t parts = filter_parts_per_cell * filter_cells;
  for (uint32_t part = 0; part < parts; ++part) {
    const Real lowest = static_cast<Real>(part) / static_cast<Real>(parts);
    while (table[cdf + cell + 1] <= lowest) ++cell;
    table.push_back(static_cast<Real>(cell));
  }
  return negative;
}

template <class Real>
FilterRecord<Real> filter_record(const Filter& filter, std::vector<Real>& table) {
  FilterRecord<Real> record;
  if (!(filter.x_radius > 0 && filter.y_radius > 0) || filter.x_radius > max_filter_radius ||
      filter.y_radius > max_filter_radius)
    throw InputError("the radius of the pixel filter must be above 0 and at most 64 pixels");
  record.x_radius = static_cast<Real>(filter.x_radius);
  record.y_radius = static_cast<Real>(filter.y_radius);
  if (filter.type == FilterType::box) return record;
  record.cells = filter_cells;
  const bool negative_x = add_filter_axis(filter, filter.x_radius, table);
  const bool negative_y = add_filter_axis(filter, filter.y_radius, table);
  record.has_negative = negative_x || negative_y ? 1 : 0;
  return record;
}

/// If the camera were not finite, its rays would not be either.
template <class Real>
void check_camera(const std::string& scene_name, const CameraRecord<Real>& camera) {
  bool finite = true;
  for (const Real value : {camera.x_scale, camera.x_offset, camera.y_scale, camera.y_offset, camera.lens_radius,
                           camera.focal_distance, camera.inverse_scale})
    finite = finite && std::isfinite(value);
  for (const auto& row : camera.world_from_camera)
    for (const Real value : row) finite = finite && std::isfinite(value);
  if (!finite)
    throw InputError({scene_name},
                     "the camera is not finite in this precision: its transform, its screen window or its lens is too "
                     "large or too small");
}

}  // namespace

double filter_value(const Filter& filter, double x, double radius) {
  switch (filter.type) {
    case FilterType::box:
      return 1;
    case FilterType::triangle:
      return std::max(0.0, radius - std::abs(x));
    case FilterType::gaussian:
      return std::max(0.0, gaussian(x, filter.sigma) - gaussian(radius, filter.sigma));
    case FilterType::mitchell:
      return mitchell(2 * x / radius, filter.b, filter.c);
    case FilterType::sinc:
      return std::abs(x) < radius ? sinc(x) * sinc(x / filter.tau) : 0;
  }
  return 0;
}

template <class Real>
CameraRecord<Real> camera_record(const Camera& camera, const std::string& scene_name, int64_t width, int64_t height) {
  if (!(camera.fov > 0 && camera.fov < 180)) throw InputError("the camera's field of view must be between 0 and 180");
  const double aspect = camera.frame_aspect_ratio.value_or(static_cast<double>(width) / static_cast<double>(height));
  std::array<double, 4> window = aspect > 1 ? std::array<double, 4>{-aspect, aspect, -1, 1}
                                            : std::array<double, 4>{-1, 1, -1 / aspect, 1 / aspect};
  if (camera.screen_window) window = *camera.screen_window;
  double scale = std::tan(camera.fov * std::numbers::pi / 360);
  CameraRecord<Real> record{};
  record.kind = camera.kind;
  if (camera.kind == CameraKind::orthographic) scale = 1;
  const bool sees_all = camera.kind == CameraKind::equirectangular || camera.kind == CameraKind::equal_area;
  if (sees_all) {
    scale = 1;
    window = {0, 1, 1, 0};
  }
  record.x_scale = static_cast<Real>((window[1] - window[0]) * scale / static_cast<double>(width));
  record.x_offset = static_cast<Real>(window[0] * scale);
  record.y_scale = static_cast<Real>(-(window[3] - window[2]) * scale / static_cast<double>(height));
  record.y_offset = static_cast<Real>(window[3] * scale);
  record.lens_radius = static_cast<Real>(camera.lens_radius);
  record.focal_distance = static_cast<Real>(camera.focal_distance);
  const Matrix4& m = camera.world_from_camera.start.matrix();
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) record.world_from_camera[i][j] = static_cast<Real>(m[i][j] / m[3][3]);
  const double axis = std::sqrt(m[0][2] * m[0][2] + m[1][2] * m[1][2] + m[2][2] * m[2][2]) / std::abs(m[3][3]);
  record.inverse_scale = static_cast<Real>(1 / axis);
  const double pixel = std::abs((window[1] - window[0]) * (window[3] - window[2])) * scale * scale /
                       (static_cast<double>(width) * static_cast<double>(height));
  const double unit = sees_all ? 4 * std::numbers::pi : camera.kind == CameraKind::orthographic ? axis * axis : 1;
  record.footprint = static_cast<Real>(pixel * unit / 4);
  check_camera(scene_name, record);
  return record;
}

template <class Real>
void compile_camera(const Scene& scene, int64_t width, int64_t height, SceneArrays<Real>& out, SceneView<Real>& view,
                    Diagnostics& diagnostics) {
  view.camera = camera_record<Real>(scene.camera, scene.name, width, height);
  if (scene.camera.world_from_camera.is_moving())
    diagnostics.warn({scene.name}, "the camera moves; it is rendered at rest, where it is when the shutter opens");
  view.filter = filter_record(scene.filter, out.filter_cdf);
  view.exposure = static_cast<Real>(scene.film.exposure);
}

template CameraRecord<float> camera_record(const Camera&, const std::string&, int64_t, int64_t);
template CameraRecord<double> camera_record(const Camera&, const std::string&, int64_t, int64_t);
template void compile_camera(const Scene&, int64_t, int64_t, SceneArrays<float>&, SceneView<float>&, Diagnostics&);
template void compile_camera(const Scene&, int64_t, int64_t, SceneArrays<double>&, SceneView<double>&, Diagnostics&);

}  // namespace alhazen::impl
