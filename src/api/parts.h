#pragma once

// Handles of a scene's parts: checked, and made.

#include <string_view>

#include "api/arguments.h"
#include "api/scene_state.h"

namespace alhazen::impl {

/// The index of a part, of which there are `count`. Throws InputError that names the argument.
template <class Part>
uint32_t index_of(std::string_view argument, const Handle<Part>& handle, const PartOwners& owners, size_t count) {
  if (!handle) refuse_argument(argument, "is a handle that names nothing");
  const uint32_t index = HandleAccess::index(handle);
  if (index >= count || owners.of(index) != HandleAccess::scene(handle))
    refuse_argument(argument, "is a handle of another scene");
  return index;
}

inline uint32_t index_of(std::string_view argument, MeshId handle, const SceneState& state) {
  return index_of(argument, handle, state.meshes, state.description.meshes.size());
}
inline uint32_t index_of(std::string_view argument, ImageId handle, const SceneState& state) {
  return index_of(argument, handle, state.images, state.description.images.size());
}
inline uint32_t index_of(std::string_view argument, TextureId handle, const SceneState& state) {
  return index_of(argument, handle, state.textures, state.description.textures.size());
}
inline uint32_t index_of(std::string_view argument, MaterialId handle, const SceneState& state) {
  return index_of(argument, handle, state.materials, state.description.materials.size());
}
inline uint32_t index_of(std::string_view argument, GroupId handle, const SceneState& state) {
  return index_of(argument, handle, state.groups, state.description.groups.size());
}
/// The place in the description.
inline ShapePlace index_of(std::string_view argument, ShapeId handle, const SceneState& state) {
  const ShapePlace place = state.shape_places[index_of(argument, handle, state.shapes, state.shape_places.size())];
  if (place.group == no_index) refuse_argument(argument, "is a handle of a shape that was removed");
  return place;
}
inline uint32_t index_of(std::string_view argument, InstanceId handle, const SceneState& state) {
  const uint32_t place =
      state.instance_places[index_of(argument, handle, state.instances, state.instance_places.size())];
  if (place == no_index) refuse_argument(argument, "is a handle of an instance that was removed");
  return place;
}
inline uint32_t index_of(std::string_view argument, LightId handle, const SceneState& state) {
  const uint32_t place = state.light_places[index_of(argument, handle, state.lights, state.light_places.size())];
  if (place == no_index) refuse_argument(argument, "is a handle of a light that was removed");
  return place;
}

/// The handle of a part, none for no_index.
template <class Id>
Id handle_of(uint32_t index, const PartOwners& owners) {
  return index == no_index ? Id{} : HandleAccess::make<Id>(index, owners.of(index));
}

}  // namespace alhazen::impl
