// What is under a pixel.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "api/parts.h"
#include "api/scene_state.h"
#include "view/scene_edit.h"

namespace alhazen::impl {

namespace {

/// Surfaces that one ray passes through at most: a forest's leaves are fewer.
constexpr int max_cutouts = 256;

double wrapped(double x, ::alhazen::WrapMode mode) {
  switch (mode) {
    case ::alhazen::WrapMode::repeat:
      return x - std::floor(x);
    case ::alhazen::WrapMode::mirror: {
      const double period = x - 2 * std::floor(x / 2);
      return period > 1 ? 2 - period : period;
    }
    case ::alhazen::WrapMode::clamp:
      return std::clamp(x, 0.0, 1.0);
    case ::alhazen::WrapMode::black:
      break;
  }
  return x;
}

/// Red of a texture, at the nearest texel of images; nothing where it is of another kind or not over the mesh's uvs.
std::optional<double> red_of(const ::alhazen::Scene& scene, TextureId id, double u, double v);

std::optional<double> red_of(const ::alhazen::Scene& scene, const ColourInput& input, double u, double v) {
  return input.is_texture() ? red_of(scene, input.texture(), u, v) : std::optional(input.colour().r);
}

std::optional<double> red_of(const ::alhazen::Scene& scene, TextureId id, double u, double v) {
  const ::alhazen::Texture texture = scene.texture(id);
  if (const auto* constant = std::get_if<::alhazen::ConstantTexture>(&texture.node)) return constant->value.r;
  if (const auto* scale = std::get_if<::alhazen::ScaleTexture>(&texture.node)) {
    const std::optional<double> value = red_of(scene, scale->value, u, v), factor = red_of(scene, scale->factor, u, v);
    return value && factor ? std::optional(*value * *factor) : std::nullopt;
  }
  if (const auto* threshold = std::get_if<::alhazen::ThresholdTexture>(&texture.node)) {
    const std::optional<double> value = red_of(scene, threshold->input, u, v);
    return value ? std::optional(*value >= threshold->edge.r ? 1.0 : 0.0) : std::nullopt;
  }
  const auto* image = std::get_if<::alhazen::ImageTexture>(&texture.node);
  if (!image || image->mapping.kind != ::alhazen::MappingKind::uv || image->mapping.uv_set != 0) return std::nullopt;
  const ::alhazen::TextureMapping& m = image->mapping;
  const double angle = m.rotation * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const double su = m.scale.x * u, sv = m.scale.y * v;
  const double x = wrapped(c * su - s * sv + m.offset.x, image->wrap),
               y = wrapped(s * su + c * sv + m.offset.y, image->wrap_t.value_or(image->wrap));
  if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return image->invert ? 1 : 0;
  const ImageTexels& texels = scene.state().description.images[index_of("image", image->image, scene.state())];
  const int column = std::min(static_cast<int>(x * texels.width), texels.width - 1),
            row = std::min(static_cast<int>((1 - y) * texels.height), texels.height - 1);
  const size_t at = (static_cast<size_t>(row) * static_cast<size_t>(texels.width) + static_cast<size_t>(column)) *
                    static_cast<size_t>(texels.channels);
  // Whether it is under a half hardly depends on the encoding: opacities are linear.
  double value = texels.floats.empty() ? texels.bytes[at] / 255.0 : static_cast<double>(texels.floats[at]);
  value *= image->scale;
  return image->invert ? 1 - value : value;
}

bool is_cut_out(const ::alhazen::Scene& scene, MaterialId id, double u, double v) {
  if (!id) return false;
  const NumberInput alpha = scene.material(id).alpha;
  if (!alpha.is_texture()) return alpha.number() < 0.5;
  return red_of(scene, alpha.texture(), u, v).value_or(1) < 0.5;
}

std::string place_of(const SourceLocation& where) {
  if (where.file.empty()) return {};
  return SourceLocation{where.file, where.line, 0}.to_string();
}

double dot_of(const ::alhazen::Vec3& a, const ::alhazen::Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length_of(const ::alhazen::Vec3& v) { return std::sqrt(dot_of(v, v)); }

/// The direction at a point of the octahedral square, y down and z up (core/lights/sphere_mapping.h).
::alhazen::Vec3 equal_area_direction(double u, double v) {
  const double x = 2 * u - 1, y = 2 * v - 1;
  const bool is_upper = std::abs(x) + std::abs(y) <= 1;
  const double a = is_upper ? std::abs(x) : 1 - std::abs(y), b = is_upper ? std::abs(y) : 1 - std::abs(x), r = a + b;
  const double angle = r > 0 ? std::numbers::pi / 2 * (b / r) : 0, to_axis = r * std::sqrt(2 - r * r), z = 1 - r * r;
  return {std::copysign(std::cos(angle) * to_axis, x), std::copysign(std::sin(angle) * to_axis, y), is_upper ? z : -z};
}

}  // namespace

PixelRay pixel_ray(const ::alhazen::Camera& camera, int width, int height, double x, double y) {
  const double u = x / width, v = y / height;
  const ::alhazen::Transform& to_world = camera.transform.start;
  PixelRay ray;
  ::alhazen::Vec3 origin{}, direction{};
  if (camera.kind == ::alhazen::CameraKind::perspective || camera.kind == ::alhazen::CameraKind::orthographic) {
    const double aspect = camera.frame_aspect_ratio.value_or(static_cast<double>(width) / height);
    const std::array<double, 4> whole = aspect > 1 ? std::array<double, 4>{-aspect, aspect, -1, 1}
                                                   : std::array<double, 4>{-1, 1, -1 / aspect, 1 / aspect};
    const std::array<double, 4> window = camera.screen_window.value_or(whole);
    const double px = window[0] + u * (window[1] - window[0]), py = window[3] - v * (window[3] - window[2]);
    if (camera.kind == ::alhazen::CameraKind::orthographic) {
      origin = {px, py, 0};
      direction = {0, 0, 1};
    } else {
      const double scale = std::tan(camera.fov * std::numbers::pi / 360);
      direction = {scale * px, scale * py, 1};
    }
    ray.direction = to_world.direction(direction);
    ray.distance_per_t = 1;  // the z of `direction`
  } else {
    ::alhazen::Vec3 d;
    if (camera.kind == ::alhazen::CameraKind::equal_area) {
      d = equal_area_direction(u, v);
    } else {
      const double theta = v * std::numbers::pi, phi = u * 2 * std::numbers::pi;
      d = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    direction = {d.x, d.z, d.y};
    ray.direction = to_world.direction(direction);
    ray.distance_per_t = length_of(ray.direction);
  }
  ray.origin = to_world.point(origin);
  return ray;
}

std::optional<PickedPoint> Picker::pick(const ::alhazen::Scene& scene, int width, int height, int x, int y,
                                        const ProgressFunction& building) {
  if (x < 0 || y < 0 || x >= width || y >= height)
    throw InputError("pick: the pixel " + std::to_string(x) + ", " + std::to_string(y) + " is outside the image of " +
                     std::to_string(width) + " by " + std::to_string(height));
  const SceneState& state = scene.state();
  const Built now{state.id, state.revisions.geometry, state.revisions.transforms};
  if (!queries_ || built_ != now) {
    queries_.reset();
    Settings settings;
    settings.precision = "double";  // so that passing through a cutout never finds it again
    queries_.emplace(scene, settings, building);
    built_ = now;
  }
  const PixelRay first = pixel_ray(scene.camera(), width, height, x + 0.5, y + 0.5);
  PixelRay ray = first;
  for (int i = 0; i < max_cutouts; ++i) {
    double offset = 0;
    std::array<double, 3> position{}, normal{};
    std::array<double, 2> uv{};
    uint32_t shape = 0, instance = 0;
    const std::array<double, 3> origin{ray.origin.x, ray.origin.y, ray.origin.z},
        direction{ray.direction.x, ray.direction.y, ray.direction.z};
    RayArrays<double> rays;
    rays.origins = origin.data();
    rays.directions = direction.data();
    rays.count = 1;
    HitArrays<double> hits;
    hits.positions = position.data();
    hits.normals = normal.data();
    hits.uvs = uv.data();
    hits.offsets = &offset;
    hits.shapes = &shape;
    hits.instances = &instance;
    queries_->closest_hits(rays, hits, 1);
    if (shape == invalid_id) return std::nullopt;
    PickedPoint point;
    GroupId group;
    if (instance != invalid_id) {
      point.instance = scene.instances()[instance];
      group = scene.instance(point.instance).group;
      point.instance_name = scene.name(point.instance);
    }
    point.shape = scene.shapes(group)[shape];
    point.material = scene.shape(point.shape).material;
    const ::alhazen::Vec3 n{normal[0], normal[1], normal[2]};
    const double facing = dot_of(n, ray.direction);
    if (is_cut_out(scene, point.material, uv[0], uv[1])) {
      const double side = facing > 0 ? offset : -offset;
      ray.origin = {position[0] + side * n.x, position[1] + side * n.y, position[2] + side * n.z};
      continue;
    }
    point.object = scene.name(point.shape);
    const ShapePlace place = index_of("shape", point.shape, state);
    point.where = place_of(state.description.groups[place.group].shapes[place.index].where);
    point.position = {position[0], position[1], position[2]};
    point.normal = facing > 0 ? ::alhazen::Vec3{-n.x, -n.y, -n.z} : n;
    const ::alhazen::Vec3 way{position[0] - first.origin.x, position[1] - first.origin.y, position[2] - first.origin.z};
    point.distance = dot_of(way, first.direction) / dot_of(first.direction, first.direction) * first.distance_per_t;
    return point;
  }
  return std::nullopt;
}

}  // namespace alhazen::impl
