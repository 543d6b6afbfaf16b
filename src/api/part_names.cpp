#include "api/part_names.h"

#include <utility>

#include "api/scene_state.h"
#include "scene/scene_names.h"

namespace alhazen::impl {

namespace {

/// Objects of the world first, then what the groups contain.
void name_objects(const SceneState& state, PartNames& result) {
  const Scene& scene = state.description;
  SceneNames names(scene);
  std::vector<std::vector<uint32_t>> ids(scene.groups.size());
  for (const Shape& shape : scene.groups[0].shapes) ids[0].push_back(names.object_id(shape));
  std::vector<uint32_t> instance_ids;
  for (const std::string& name : instance_names(scene)) instance_ids.push_back(names.new_object_id(name));
  for (size_t group = 1; group < scene.groups.size(); ++group)
    for (const Shape& shape : scene.groups[group].shapes) ids[group].push_back(names.object_id(shape));
  for (const ShapePlace& place : state.shape_places)
    result.shapes.push_back(place.group == no_index ? std::string()
                                                    : names.objects()[ids[place.group][place.index] - 1]);
  for (const uint32_t place : state.instance_places)
    result.instances.push_back(place == no_index ? std::string() : names.objects()[instance_ids[place] - 1]);
}

PartNames::Indices indices_of(const std::vector<std::string>& names) {
  PartNames::Indices indices;
  for (uint32_t i = 0; i < names.size(); ++i)
    if (!names[i].empty()) indices[names[i]].push_back(i);
  return indices;
}

bool is_of(const PartNames& names, const SceneRevisions& now) {
  return names.geometry == now.geometry && names.of_materials == now.materials && names.of_lights == now.lights &&
         names.environment == now.environment;
}

}  // namespace

std::shared_ptr<const PartNames> PartNameCache::of(const SceneState& state) const {
  const std::lock_guard lock(mutex_);
  const SceneRevisions& now = state.revisions;
  if (names_ && is_of(*names_, now)) return names_;
  auto made = std::make_shared<PartNames>();
  name_objects(state, *made);
  made->materials = material_names(state.description);
  const std::vector<std::string> lights = light_names(state.description);
  for (const uint32_t place : state.light_places)
    made->lights.push_back(place == no_index ? std::string() : lights[place]);
  made->shapes_of = indices_of(made->shapes);
  made->instances_of = indices_of(made->instances);
  made->materials_of = indices_of(made->materials);
  made->lights_of = indices_of(made->lights);
  made->geometry = now.geometry;
  made->of_materials = now.materials;
  made->of_lights = now.lights;
  made->environment = now.environment;
  return names_ = std::move(made);
}

}  // namespace alhazen::impl
