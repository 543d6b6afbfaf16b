#include "render/image_layers.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/shapes/instance.h"
#include "render/cryptomatte.h"

namespace alhazen::impl {

template <class Real>
LayerScene::LayerScene(const CompiledScene<Real>& scene)
    : world_origin(scene.world_origin),
      kind(scene.view.camera.kind),
      object_names(scene.object_names),
      material_names(scene.material_names),
      light_groups(scene.light_groups) {
  const CameraRecord<Real>& camera = scene.view.camera;
  x_scale = static_cast<double>(camera.x_scale), x_offset = static_cast<double>(camera.x_offset);
  y_scale = static_cast<double>(camera.y_scale), y_offset = static_cast<double>(camera.y_offset);
  double there[3][4];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) there[i][j] = static_cast<double>(camera.world_from_camera[i][j]);
  const auto column = [&](int j) { return Vec3d{there[0][j], there[1][j], there[2][j]}; };
  const auto axis = [&](int j) { return normalize(column(j)); };
  const bool is_planar = kind == CameraKind::perspective || kind == CameraKind::orthographic;
  right = axis(0) * (is_planar && x_scale < 0 ? -1.0 : 1.0);
  up = axis(1) * (is_planar && y_scale > 0 ? -1.0 : 1.0);
  forward = axis(2);
  eye = column(3);
  invert(there, camera_from_render);
}

template LayerScene::LayerScene(const CompiledScene<float>&);
template LayerScene::LayerScene(const CompiledScene<double>&);

Vec2d LayerScene::project(const Vec3d& point) const {
  Vec3d p = transform_point(camera_from_render, point);
  if (kind == CameraKind::perspective) p = p / p.z;
  return {(p.x - x_offset) / x_scale, (p.y - y_offset) / y_scale};
}

namespace {

template <class Real>
class Layers {
 public:
  static std::vector<ImageLayer<Real>> all() {
    return {
        {&AovSet::alpha,
         {"alpha.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) {
           put(std::clamp(f.coverage(i), Real(0), Real(1)), out);
         }},
        {&AovSet::albedo,
         {"albedo.R", "albedo.G", "albedo.B"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put3(mean(f.albedo[i], f.samples[i]), out); }},
        {&AovSet::normal,
         {"normal.X", "normal.Y", "normal.Z"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put3(mean(f.normal[i], f.samples[i]), out); }},
        {&AovSet::camera_normal,
         {"camera_normal.X", "camera_normal.Y", "camera_normal.Z"},
         [](const Film& f, const LayerScene& scene, size_t i, float* out) {
           const Vec3d n = convert<double>(mean(f.normal[i], f.samples[i]));
           put3(Vec3d{dot(n, scene.right), dot(n, scene.up), -dot(n, scene.forward)}, out);
         }},
        {&AovSet::depth,
         {"depth.Z"},
         [](const Film& f, const LayerScene& scene, size_t i, float* out) { put(depth(f, scene, i), out); }},
        {&AovSet::distance,
         {"distance.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) {
           put(f.hits[i] > 0 ? f.depth[i] / static_cast<Real>(f.hits[i]) : Real(0), out);
         }},
        {&AovSet::position,
         {"position.X", "position.Y", "position.Z"},
         [](const Film& f, const LayerScene& scene, size_t i, float* out) {
           put3(f.points[i] > 0 ? point(f, i) + scene.world_origin : Vec3d{}, out);
         }},
        {&AovSet::uv,
         {"uv.U", "uv.V"},
         [](const Film& f, const LayerScene&, size_t i, float* out) {
           const Real n = f.points[i] > 0 ? static_cast<Real>(f.points[i]) : Real(1);
           put(f.uv[i].x / n, out);
           put(f.uv[i].y / n, out + 1);
         }},
        {&AovSet::motion, {"motion.X", "motion.Y"}, put_motion},
        {&AovSet::object,
         {"object.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put_id(f.objects[i], out); }},
        {&AovSet::material,
         {"material.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put_id(f.materials[i], out); }},
        {&AovSet::cryptomatte, cryptomatte_channels("CryptoObject"),
         [](const Film& f, const LayerScene& scene, size_t i, float* out) {
           put_matte(f.objects[i], scene.object_names, out);
         }},
        {&AovSet::cryptomatte, cryptomatte_channels("CryptoMaterial"),
         [](const Film& f, const LayerScene& scene, size_t i, float* out) {
           put_matte(f.materials[i], scene.material_names, out);
         }},
        component<LightPart::emission>("emission"),
        component<LightPart::diffuse_direct>("diffuse_direct"),
        component<LightPart::diffuse_indirect>("diffuse_indirect"),
        component<LightPart::specular_direct>("specular_direct"),
        component<LightPart::specular_indirect>("specular_indirect"),
        component<LightPart::transmission_direct>("transmission_direct"),
        component<LightPart::transmission_indirect>("transmission_indirect"),
        {&AovSet::light_groups, {}, put_groups, group_channels},
        {&AovSet::bounces,
         {"bounces.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) {
           const Real n = static_cast<Real>(f.samples[i]);
           put(n > 0 ? static_cast<Real>(f.segments[i]) / n : Real(0), out);
         }},
        {&AovSet::samples,
         {"samples.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put(f.samples[i], out); }},
        {&AovSet::variance,
         {"variance.Y"},
         [](const Film& f, const LayerScene&, size_t i, float* out) { put(f.sample_variance(i), out); }},
    };
  }

 private:
  using Film = FilmView<Real>;

  template <class Value>
  static void put(Value value, float* out) {
    *out = static_cast<float>(value);
  }
  template <class Value>
  static void put3(const Vec3<Value>& value, float* out) {
    put(value.x, out);
    put(value.y, out + 1);
    put(value.z, out + 2);
  }
  static Vec3<Real> mean(const Vec3<Real>& sum, uint32_t count) {
    return count > 0 ? sum / static_cast<Real>(count) : Vec3<Real>{};
  }

  template <LightPart part>
  static ImageLayer<Real> component(const std::string& name) {
    return {&AovSet::components,
            {name + ".R", name + ".G", name + ".B"},
            [](const Film& f, const LayerScene&, size_t i, float* out) { put3(f.part_of_light(i, part), out); }};
  }

  static std::vector<std::string> group_channels(const LayerScene& scene) {
    std::vector<std::string> channels;
    for (const std::string& group : scene.light_groups)
      for (const char* colour : {".R", ".G", ".B"}) channels.push_back("light_" + group + colour);
    return channels;
  }

  static void put_groups(const Film& f, const LayerScene& scene, size_t i, float* out) {
    for (uint32_t g = 0; g < scene.light_groups.size(); ++g) put3(f.light_of_group(i, g), out + 3 * g);
  }

  /// The mean of the first points of a pixel that has some, in render space.
  static Vec3d point(const Film& f, size_t i) {
    return convert<double>(f.position[i]) / static_cast<double>(f.points[i]);
  }

  static double depth(const Film& f, const LayerScene& scene, size_t i) {
    if (f.points[i] == 0) return 0;
    const Vec3d from_eye = point(f, i) - scene.eye;
    const bool is_planar = scene.kind == CameraKind::perspective || scene.kind == CameraKind::orthographic;
    return is_planar ? dot(from_eye, scene.forward) : length(from_eye);
  }

  static void put_motion(const Film& f, const LayerScene& scene, size_t i, float* out) {
    out[0] = out[1] = 0;
    if (f.points[i] == 0 || is_zero(f.displacement[i])) return;
    const Vec3d displacement = convert<double>(f.displacement[i]) / static_cast<double>(f.points[i]);
    // Points are recorded throughout the shutter interval, so their mean is that of its middle.
    const Vec3d middle = point(f, i);
    const Vec3d from = middle - displacement * 0.5, to = middle + displacement * 0.5;
    const auto is_before = [&](const Vec3d& p) { return dot(p - scene.eye, scene.forward) > 0; };
    if (scene.kind == CameraKind::perspective && !(is_before(from) && is_before(to))) return;
    const Vec2d open = scene.project(from), close = scene.project(to);
    const double x = close.x - open.x, y = open.y - close.y;
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    put(x, out);
    put(y, out + 1);
  }

  static void put_id(const Coverage<Real>& coverage, float* out) {
    const auto largest = std::max_element(std::begin(coverage.weights), std::end(coverage.weights));
    put(coverage.ids[largest - std::begin(coverage.weights)], out);
  }

  static void put_matte(const Coverage<Real>& coverage, const std::vector<std::string>& names, float* out) {
    std::fill_n(out, 2 * cryptomatte_levels, 0.0f);
    uint32_t order[Coverage<Real>::slots];
    uint32_t count = 0;
    while (count < Coverage<Real>::slots && coverage.ids[count] != no_id) {
      order[count] = count;
      ++count;
    }
    std::stable_sort(order, order + count,
                     [&](uint32_t a, uint32_t b) { return coverage.weights[a] > coverage.weights[b]; });
    for (uint32_t k = 0; k < std::min<uint32_t>(count, cryptomatte_levels); ++k) {
      const Real weight = coverage.weights[order[k]];
      if (!(weight > 0 && coverage.total > 0)) break;
      const std::string& name = names.at(coverage.ids[order[k]] - 1);
      out[2 * k] = cryptomatte_id(murmur3_32(name));
      put(std::min(weight / coverage.total, Real(1)), out + 2 * k + 1);
    }
  }
};

template <class Real>
std::vector<std::string> visible_names(const Coverage<Real>* plane, size_t pixels,
                                       const std::vector<std::string>& names) {
  std::vector<bool> is_visible(names.size() + 1);
  for (size_t i = 0; i < pixels; ++i)
    for (const uint32_t id : plane[i].ids) is_visible.at(id) = true;
  std::vector<std::string> visible;
  for (size_t id = 1; id < is_visible.size(); ++id)
    if (is_visible[id]) visible.push_back(names[id - 1]);
  return visible;
}

/// The numbers of the names that appear, as a JSON object.
std::string numbers_of(const std::vector<std::string>& visible, const std::vector<std::string>& names) {
  const std::set<std::string> shown(visible.begin(), visible.end());
  nlohmann::json numbers = nlohmann::json::object();
  for (size_t i = 0; i < names.size(); ++i)
    if (shown.count(names[i])) numbers[names[i]] = i + 1;
  return numbers.dump();
}

}  // namespace

template <class Real>
const std::vector<ImageLayer<Real>>& image_layers() {
  static const std::vector<ImageLayer<Real>> layers = Layers<Real>::all();
  return layers;
}

template const std::vector<ImageLayer<float>>& image_layers();
template const std::vector<ImageLayer<double>>& image_layers();

bool wants_names(const AovSet& aovs) { return aovs.object || aovs.material || aovs.cryptomatte; }

template <class Real>
std::map<std::string, std::string> layer_metadata(const FilmView<Real>& film, size_t pixels, const AovSet& aovs,
                                                  const LayerScene& scene) {
  std::map<std::string, std::string> metadata;
  const auto add = [&](const Coverage<Real>* plane, const std::vector<std::string>& names, const char* matte,
                       bool has_ids, const char* ids) {
    if (!plane) return;
    const std::vector<std::string> visible = visible_names(plane, pixels, names);
    if (aovs.cryptomatte) metadata.merge(cryptomatte_metadata(matte, visible));
    if (has_ids) metadata[ids] = numbers_of(visible, names);
  };
  add(film.objects, scene.object_names, "CryptoObject", aovs.object, "object");
  add(film.materials, scene.material_names, "CryptoMaterial", aovs.material, "material");
  return metadata;
}

template std::map<std::string, std::string> layer_metadata(const FilmView<float>&, size_t, const AovSet&,
                                                           const LayerScene&);
template std::map<std::string, std::string> layer_metadata(const FilmView<double>&, size_t, const AovSet&,
                                                           const LayerScene&);

}  // namespace alhazen::impl
