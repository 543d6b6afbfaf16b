#include "api/scene_state.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "alhazen/alhazen.h"
#include "geometry/quadrics.h"
#include "pipeline/choose_view.h"
#include "scene/default_view.h"
#include "scene/outline.h"

namespace alhazen::impl {

namespace {

uint32_t new_scene_id() {
  static std::atomic<uint32_t> last{0};
  uint32_t id = ++last;
  while (id == 0) id = ++last;  // 0 is of handles that name nothing
  return id;
}

std::vector<uint32_t> places_of(size_t count) {
  std::vector<uint32_t> places(count);
  std::iota(places.begin(), places.end(), 0u);
  return places;
}

bool has_light(const Scene& scene) {
  return !scene.lights.empty() || std::any_of(scene.groups.begin(), scene.groups.end(), [](const ShapeGroup& group) {
    return std::any_of(group.shapes.begin(), group.shapes.end(),
                       [](const Shape& shape) { return shape.emission.has_value(); });
  });
}

}  // namespace

uint32_t PartOwners::of(uint32_t index) const {
  const auto next = std::upper_bound(owners_.begin(), owners_.end(), index,
                                     [](uint32_t i, const Owner& owner) { return i < owner.first; });
  return std::prev(next)->scene;
}

void PartOwners::add(uint32_t index, uint32_t scene) {
  if (owners_.back().scene != scene) owners_.push_back({index, scene});
}

SceneState::SceneState()
    : id(new_scene_id()),
      meshes(id),
      images(id),
      textures(id),
      materials(id),
      shapes(id),
      groups(id),
      instances(id),
      lights(id) {
  // As of a file that is a mesh alone.
  description.up = {0, 1, 0};
  description.camera.is_default = true;
  description.samples_per_pixel = 64;
  description.quality = "good";
  description.max_depth = 8;
}

SceneState::SceneState(Scene&& scene, const Diagnostics& diagnostics, std::shared_ptr<InputRecord> inputs_)
    : SceneState() {
  description = std::move(scene);
  warnings = diagnostics.warnings();
  inputs = std::move(inputs_);
  is_read = true;
  for (uint32_t group = 0; group < description.groups.size(); ++group)
    for (uint32_t i = 0; i < description.groups[group].shapes.size(); ++i) shape_places.push_back({group, i});
  instance_places = places_of(description.instances.size());
  light_places = places_of(description.lights.size());
  for (const Texture& texture : description.textures)
    constant_uses.push_back(texture.kind == TextureKind::constant && texture.name.empty() ? ConstantUse::value
                                                                                          : ConstantUse::texture);
}

SceneState::SceneState(const SceneState& other)
    : description(other.description),
      revisions(other.revisions),
      warnings(other.warnings),
      inputs(other.inputs),
      is_read(other.is_read),
      id(new_scene_id()),
      meshes(other.meshes),
      images(other.images),
      textures(other.textures),
      materials(other.materials),
      shapes(other.shapes),
      groups(other.groups),
      instances(other.instances),
      lights(other.lights),
      shape_places(other.shape_places),
      instance_places(other.instance_places),
      light_places(other.light_places),
      constant_uses(other.constant_uses),
      unused_constants(other.unused_constants) {}

Camera default_camera(const Scene& scene, double aspect) {
  Camera camera = fitted_camera(scene, aspect);
  // It is placed for scenes whose y is up.
  if (scene.up.y > 0 || length(scene.up) == 0) return camera;
  Settings settings;
  settings.orbit = {30, 20};
  if (aspect > 0) {
    settings.height = 10'000;
    settings.width = std::max<int64_t>(1, std::llround(aspect * 10'000));
  }
  camera = chosen_camera(settings, scene, camera);
  camera.is_default = true;
  return camera;
}

Scene SceneState::outline_to_render(const Camera& camera, bool with_light_maps) const {
  Scene outline = outline_of(description, with_light_maps);
  tessellate_inexact_quadrics(outline);
  outline.camera = camera;
  if (!is_read && !has_light(outline)) add_neutral_light(outline);
  return outline;
}

Scene SceneState::to_render(double aspect) const {
  Scene scene = description;
  tessellate_inexact_quadrics(scene);
  if (scene.camera.is_default) scene.camera = default_camera(scene, aspect);
  if (!is_read && !has_light(scene)) add_neutral_light(scene);
  return scene;
}

}  // namespace alhazen::impl
