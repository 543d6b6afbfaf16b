// The names of a public scene's parts.

#include <algorithm>
#include <string>
#include <vector>

#include "alhazen/scene.h"
#include "api/parts.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// Those of that name, in the order in which they were added.
template <class Id>
std::vector<Id> named(const std::string& name, const impl::PartNames::Indices& indices,
                      const impl::PartOwners& owners) {
  std::vector<Id> found;
  if (const auto entry = indices.find(name); entry != indices.end())
    for (const uint32_t index : entry->second) found.push_back(impl::handle_of<Id>(index, owners));
  return found;
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
  return state().names.of(state())->materials[impl::index_of("material", material, state())];
}

std::string Scene::name(ShapeId shape) const {
  impl::index_of("shape", shape, state());
  return state().names.of(state())->shapes[impl::HandleAccess::index(shape)];
}

std::string Scene::name(InstanceId instance) const {
  impl::index_of("instance", instance, state());
  return state().names.of(state())->instances[impl::HandleAccess::index(instance)];
}

std::string Scene::name(LightId light) const {
  impl::index_of("light", light, state());
  return state().names.of(state())->lights[impl::HandleAccess::index(light)];
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
  const std::vector<MaterialId> found =
      named<MaterialId>(name, state().names.of(state())->materials_of, state().materials);
  return found.empty() ? MaterialId{} : found.front();
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
  std::vector<ShapeId> found = named<ShapeId>(name, state().names.of(state())->shapes_of, state().shapes);
  // As in shapes(): those of the world, then those of each group.
  std::stable_sort(found.begin(), found.end(), [&](ShapeId a, ShapeId b) {
    return impl::index_of("shape", a, state()).group < impl::index_of("shape", b, state()).group;
  });
  return found;
}

std::vector<InstanceId> Scene::find_instances(const std::string& name) const {
  return named<InstanceId>(name, state().names.of(state())->instances_of, state().instances);
}

std::vector<LightId> Scene::find_lights(const std::string& name) const {
  return named<LightId>(name, state().names.of(state())->lights_of, state().lights);
}

}  // namespace ALHAZEN_NAMESPACE
