#include "scene/scene_names.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

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

/// The names that shapes, instances and lights were given.
void take_names(const Scene& scene, const std::vector<std::string>& instances, NumberedNames& numbered) {
  for (const ShapeGroup& group : scene.groups)
    for (const Shape& shape : group.shapes) numbered.take(shape.name);
  for (const std::string& name : instances) numbered.take(name);
  for (const Light& light : scene.lights) numbered.take(light.name);
}

}  // namespace

/// Names are written into headers, where bytes that are no UTF-8 would spoil all of them.
uint32_t NameTable::id_of(const std::string& file_name) {
  const std::string name = printable(file_name);
  const auto [entry, is_new] = ids_.try_emplace(name, static_cast<uint32_t>(names_.size() + 1));
  if (is_new) names_.push_back(name);
  return entry->second;
}

void NumberedNames::take(const std::string& name) {
  if (!name.empty() && name.back() >= '0' && name.back() <= '9') taken_.insert(printable(name));
}

std::string NumberedNames::next(const std::string& kind) {
  const std::string stem = printable(kind) + ".";
  uint32_t& count = counts_[stem];
  std::string name = stem + std::to_string(++count);
  while (taken_.contains(name)) name = stem + std::to_string(++count);
  return name;
}

std::vector<std::string> instance_names(const Scene& scene) {
  NumberedNames numbered;
  std::vector<std::string> names;
  for (const Instance& instance : scene.instances) names.push_back(instance.name);
  take_names(scene, names, numbered);
  for (size_t i = 0; i < names.size(); ++i) {
    const uint32_t group = scene.instances[i].group;
    if (names[i].empty() && group < scene.groups.size() && !scene.groups[group].name.empty())
      names[i] = numbered.next(scene.groups[group].name);
  }
  return names;
}

void name_instances(Scene& scene) {
  std::vector<std::string> names = instance_names(scene);
  for (size_t i = 0; i < names.size(); ++i) scene.instances[i].name = std::move(names[i]);
  const std::vector<Shape>& shapes = scene.groups.at(0).shapes;
  if (std::any_of(shapes.begin(), shapes.end(), [](const Shape& s) { return s.world_from_object.is_moving(); }))
    name_world_shapes(scene);
}

void name_world_shapes(Scene& scene) {
  SceneNames names(scene);
  for (Shape& shape : scene.groups.at(0).shapes) {
    const uint32_t id = names.object_id(shape);
    if (shape.name.empty()) shape.name = names.objects()[id - 1];
  }
}

std::vector<std::string> material_names(const Scene& scene) {
  std::unordered_set<std::string> taken;
  for (const Material& material : scene.materials) taken.insert(printable(material.name));
  std::vector<std::string> names;
  size_t beyond = scene.materials.size();
  for (const Material& material : scene.materials) {
    std::string name = printable(material.name);
    if (name.empty()) name = "material." + std::to_string(names.size() + 1);
    if (material.name.empty())
      while (taken.contains(name)) name = "material." + std::to_string(++beyond);
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<std::string> light_names(const Scene& scene) {
  NumberedNames numbered;
  take_names(scene, instance_names(scene), numbered);
  std::vector<std::string> names;
  for (const Light& light : scene.lights) {
    const bool surrounds = light.kind == LightKind::constant_infinite || light.kind == LightKind::environment;
    names.push_back(!light.name.empty() ? printable(light.name)
                    : surrounds         ? "environment"
                                        : numbered.next(light_kind_name(light.kind)));
  }
  return names;
}

SceneNames::SceneNames(const Scene& scene) : scene_(scene) {}

void SceneNames::find_taken() {
  if (has_taken_) return;
  has_taken_ = true;
  take_names(scene_, instance_names(scene_), numbered_);
}

uint32_t SceneNames::object_id(const Shape& shape, const Instance* instance) {
  if (instance) return object_id(*instance);
  uint32_t& id = object_ids_[&shape];
  if (id != no_id) return id;
  if (shape.name.empty()) find_taken();
  id = objects_.id_of(shape.name.empty() ? numbered_.next(kind_name(shape.type)) : shape.name);
  return id;
}

uint32_t SceneNames::object_id(const Instance& instance) {
  uint32_t& id = object_ids_[&instance];
  if (id == no_id) id = new_object_id(instance.name);
  return id;
}

uint32_t SceneNames::new_object_id(const std::string& instance_name) {
  if (!instance_name.empty()) return objects_.id_of(instance_name);
  find_taken();
  return objects_.id_of(numbered_.next("mesh"));
}

uint32_t SceneNames::material_id(uint32_t material) {
  if (of_no_material_.empty()) {
    of_materials_ = material_names(scene_);
    NumberedNames numbered;
    of_no_material_ = "default";
    for (const std::string& name : of_materials_) numbered.take(name);
    if (std::find(of_materials_.begin(), of_materials_.end(), of_no_material_) != of_materials_.end())
      of_no_material_ = numbered.next("default");
  }
  return materials_.id_of(material < of_materials_.size() ? of_materials_[material] : of_no_material_);
}

}  // namespace alhazen::impl
