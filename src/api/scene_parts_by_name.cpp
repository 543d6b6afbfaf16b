// The names of a public scene's parts.

#include <string>
#include <vector>

#include "alhazen/scene.h"
#include "api/parts.h"
#include "scene/scene_names.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// By the indices of the handles; empty for those that were removed.
struct ObjectNames {
  std::vector<std::string> shapes, instances;
};

/// Objects of the world first, then what the groups contain.
ObjectNames object_names(const impl::SceneState& state) {
  const impl::Scene& scene = state.description;
  impl::SceneNames names(scene);
  std::vector<std::vector<uint32_t>> ids(scene.groups.size());
  for (const impl::Shape& shape : scene.groups[0].shapes) ids[0].push_back(names.object_id(shape));
  impl::Scene placed;  // what name_instances needs
  placed.instances = scene.instances;
  for (const impl::ShapeGroup& group : scene.groups) placed.groups.push_back({group.name, {}});
  placed.groups.erase(placed.groups.begin());
  impl::name_instances(placed);
  std::vector<uint32_t> instance_ids;
  for (const impl::Instance& instance : placed.instances) instance_ids.push_back(names.object_id(instance));
  for (size_t group = 1; group < scene.groups.size(); ++group)
    for (const impl::Shape& shape : scene.groups[group].shapes) ids[group].push_back(names.object_id(shape));
  ObjectNames result;
  for (const impl::ShapePlace& place : state.shape_places)
    result.shapes.push_back(place.group == impl::no_index ? std::string()
                                                          : names.objects()[ids[place.group][place.index] - 1]);
  for (const uint32_t place : state.instance_places)
    result.instances.push_back(place == impl::no_index ? std::string() : names.objects()[instance_ids[place] - 1]);
  return result;
}

std::string material_name(const impl::Scene& scene, uint32_t index) {
  impl::SceneNames names(scene);
  names.material_id(index);
  return names.materials().front();
}

/// The first part of that name.
template <class Id, class Parts>
Id first_named(const std::string& name, const Parts& parts, const impl::PartOwners& owners) {
  for (uint32_t i = 0; i < parts.size(); ++i)
    if (parts[i].name == name) return impl::handle_of<Id>(i, owners);
  return {};
}

}  // namespace

std::string Scene::name(MaterialId material) const {
  return material_name(state().description, impl::index_of("material", material, state()));
}

std::string Scene::name(ShapeId shape) const {
  impl::index_of("shape", shape, state());
  return object_names(state()).shapes[impl::HandleAccess::index(shape)];
}

std::string Scene::name(InstanceId instance) const {
  impl::index_of("instance", instance, state());
  return object_names(state()).instances[impl::HandleAccess::index(instance)];
}

std::string Scene::name(LightId light) const {
  return impl::light_names(state().description)[impl::index_of("light", light, state())];
}

std::string Scene::name(MeshId mesh) const {
  return state().description.meshes[impl::index_of("mesh", mesh, state())].name;
}

std::string Scene::name(ImageId image) const {
  return state().description.images[impl::index_of("image", image, state())].name;
}

std::string Scene::name(TextureId texture) const {
  return state().description.textures[impl::index_of("texture", texture, state())].name;
}

std::string Scene::name(GroupId group) const {
  return state().description.groups[impl::index_of("group", group, state())].name;
}

MaterialId Scene::find_material(const std::string& name) const {
  for (uint32_t i = 0; i < state().description.materials.size(); ++i)
    if (material_name(state().description, i) == name) return impl::handle_of<MaterialId>(i, state().materials);
  return {};
}

TextureId Scene::find_texture(const std::string& name) const {
  for (const TextureId texture : textures())
    if (this->name(texture) == name) return texture;
  return {};
}

MeshId Scene::find_mesh(const std::string& name) const {
  return first_named<MeshId>(name, state().description.meshes, state().meshes);
}

ImageId Scene::find_image(const std::string& name) const {
  return first_named<ImageId>(name, state().description.images, state().images);
}

GroupId Scene::find_group(const std::string& name) const {
  for (const GroupId group : groups())
    if (this->name(group) == name) return group;
  return {};
}

std::vector<ShapeId> Scene::find_shapes(const std::string& name) const {
  const std::vector<std::string> names = object_names(state()).shapes;
  std::vector<ShapeId> found;
  for (const ShapeId shape : shapes())
    if (names[impl::HandleAccess::index(shape)] == name) found.push_back(shape);
  return found;
}

std::vector<InstanceId> Scene::find_instances(const std::string& name) const {
  const std::vector<std::string> names = object_names(state()).instances;
  std::vector<InstanceId> found;
  for (const InstanceId instance : instances())
    if (names[impl::HandleAccess::index(instance)] == name) found.push_back(instance);
  return found;
}

std::vector<LightId> Scene::find_lights(const std::string& name) const {
  const std::vector<std::string> names = impl::light_names(state().description);
  std::vector<LightId> found;
  for (const LightId light : lights())
    if (names[impl::index_of("light", light, state())] == name) found.push_back(light);
  return found;
}

}  // namespace ALHAZEN_NAMESPACE
