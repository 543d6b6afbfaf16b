#include "scene/scene_names.h"

#include <map>

#include "core/shapes/shape_records.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

const char* kind_name(ShapeType type) {
  switch (type) {
    case ShapeType::sphere:
      return "sphere";
    case ShapeType::cylinder:
      return "cylinder";
    case ShapeType::disk:
      return "disk";
    case ShapeType::mesh:
      break;
  }
  return "mesh";
}

const char* light_kind_name(LightKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case LightKind::name:          \
    return #name;
    ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
    case LightKind::triangle:
    case LightKind::sphere:
    case LightKind::moving_sphere:
      break;
  }
  return "light";
}

}  // namespace

/// Names are written into headers, where bytes that are no UTF-8 would spoil all of them.
uint32_t NameTable::id_of(const std::string& file_name) {
  const std::string name = printable(file_name);
  const auto [entry, is_new] = ids_.try_emplace(name, static_cast<uint32_t>(names_.size() + 1));
  if (is_new) names_.push_back(name);
  return entry->second;
}

void name_instances(Scene& scene) {
  std::vector<uint32_t> counts(scene.groups.size());
  for (Instance& instance : scene.instances)
    if (instance.name.empty() && instance.group < counts.size() && !scene.groups[instance.group].name.empty())
      instance.name = scene.groups[instance.group].name + "." + std::to_string(++counts[instance.group]);
}

std::vector<std::string> light_names(const Scene& scene) {
  std::vector<std::string> names;
  std::map<std::string, size_t> counts;
  for (const Light& light : scene.lights) {
    const bool surrounds = light.kind == LightKind::constant_infinite || light.kind == LightKind::environment;
    const std::string kind = light_kind_name(light.kind);
    names.push_back(!light.name.empty() ? printable(light.name)
                    : surrounds         ? "environment"
                                        : kind + "." + std::to_string(++counts[kind]));
  }
  return names;
}

SceneNames::SceneNames(const Scene& scene) : scene_(scene) {}

uint32_t SceneNames::object_id(const Shape& shape, const Instance* instance) {
  if (instance) return object_id(*instance);
  uint32_t& id = object_ids_[&shape];
  if (id == no_id) {
    const std::string kind = kind_name(shape.type);
    id = objects_.id_of(shape.name.empty() ? kind + "." + std::to_string(++counts_[kind]) : shape.name);
  }
  return id;
}

uint32_t SceneNames::object_id(const Instance& instance) {
  uint32_t& id = object_ids_[&instance];
  if (id == no_id) {
    std::string name = instance.name;
    if (name.empty()) name = "mesh." + std::to_string(++counts_["mesh"]);
    id = objects_.id_of(name);
  }
  return id;
}

uint32_t SceneNames::material_id(uint32_t material) {
  if (material >= scene_.materials.size()) return materials_.id_of("default");
  const std::string& name = scene_.materials[material].name;
  return materials_.id_of(name.empty() ? "material." + std::to_string(material + 1) : name);
}

}  // namespace alhazen::impl
