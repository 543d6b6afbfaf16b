#include "io/pbrt/build.h"

#include <utility>

#include "io/pbrt/materials.h"
#include "io/pbrt/options.h"
#include "io/pbrt/shapes.h"

namespace alhazen::impl::pbrt {

namespace {

NamedEntry& reference(std::map<std::string, NamedEntry>& entries, const std::string& name, const Place& place) {
  const auto [entry, is_new] = entries.try_emplace(name);
  if (is_new) entry->second.first_use = place;
  return entry->second;
}

void require_definitions(const std::map<std::string, NamedEntry>& entries, const std::string& what,
                         const std::string& definition) {
  for (const auto& [name, entry] : entries)
    if (!entry.defined) fail(entry.first_use, what + " \"" + name + "\" is not defined; define it with " + definition);
}

}  // namespace

Build::Build(std::string folder_, InputScope scope_, Diagnostics& diagnostics_)
    : diagnostics(diagnostics_), folder(std::move(folder_)), scope(std::move(scope_)) {}

void Build::warn_replaced(const ParameterList& list, const std::string& instead) {
  warn(list.place(), list.directive() + " is not supported; " + instead);
}

InputPath Build::existing_file(const Place& place, const std::string& name) const {
  if (name.empty()) fail(place, "the name of a file is empty");
  FoundFile found = find_file(folder, name, scope, search);
  if (found.problem.is_missing)
    fail(place, "there is no file \"" + name + "\" (looked for " + found.path.name +
                    "); paths are relative to the folder of the scene file" + search_hint(search));
  if (!found.problem.message.empty()) fail(place, "the file \"" + name + "\" " + found.problem.message);
  return found.path;
}

std::optional<InputPath> Build::existing_image(const Place& place, const std::string& name,
                                               const std::string& instead) {
  if (name.empty() || search.strict) return existing_file(place, name);
  const FoundFile found = find_file(folder, name, scope, search);
  if (!found.problem.is_missing) return existing_file(place, name);
  warn(place,
       "there is no image \"" + name + "\" (looked for " + found.path.name + "): " + instead + search_hint(search));
  return std::nullopt;
}

uint32_t Build::constant_texture(const Vec3d& value) {
  const auto [entry, is_new] = constants.try_emplace({value.x, value.y, value.z}, 0u);
  if (is_new) {
    entry->second = static_cast<uint32_t>(scene.textures.size());
    scene.textures.emplace_back().value = value;
  }
  return entry->second;
}

NamedEntry& Build::named_material(const std::string& name, const Place& place) {
  NamedEntry& entry = reference(materials, name, place);
  if (entry.index == no_index) {
    entry.index = static_cast<uint32_t>(scene.materials.size());
    scene.materials.emplace_back().name = name;
    material_is_invisible.push_back(false);
  }
  return entry;
}

NamedEntry& Build::named_object(const std::string& name, const Place& place) {
  NamedEntry& entry = reference(objects, name, place);
  if (entry.index == no_index) {
    entry.index = static_cast<uint32_t>(scene.groups.size());
    scene.groups.emplace_back().name = name;
  }
  return entry;
}

Scene Build::finish() {
  require_definitions(materials, "material", "MakeNamedMaterial");
  require_definitions(objects, "object", "ObjectBegin ... ObjectEnd");
  finish_materials(*this);
  bool any_shape = false, any_emission = !scene.lights.empty();
  for (ShapeGroup& group : scene.groups) {
    std::erase_if(group.shapes, [&](const Shape& shape) { return material_is_invisible[shape.material]; });
    any_shape = any_shape || !group.shapes.empty();
    for (const Shape& shape : group.shapes) any_emission = any_emission || shape.emission;
  }
  tessellate_for_instances(*this);
  const SourceLocation where{scene.name, 0, 0};
  if (!any_shape && scene.lights.empty())
    diagnostics.warn(where, "the scene has no shapes and no lights; the image will be black");
  else if (!any_emission)
    diagnostics.warn(where, "the scene has no lights; the image will be black");
  if (lens_image_distance) scene.camera.fov = realistic_fov(*this);
  const double shutter = scene.camera.shutter_close - scene.camera.shutter_open;
  scene.film.exposure = exposure_time.value_or(shutter) * iso / 100 * lens_exposure;
  return std::move(scene);
}

}  // namespace alhazen::impl::pbrt
