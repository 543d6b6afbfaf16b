#pragma once

// Handles of the parts of a scene.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "alhazen/version.h"

namespace alhazen::impl {
struct HandleAccess;
}

namespace ALHAZEN_NAMESPACE {

/// Names a part of one scene; each kind of part has a type of its own. A handle stays valid for as long as the scene
/// has the part, and is also valid in copies of the scene that were made after it was given. Functions that get a
/// handle of another scene, or of a part that was removed, throw InputError. A default-constructed one names nothing.
template <class Part>
class Handle {
 public:
  constexpr Handle() = default;
  constexpr explicit operator bool() const { return scene_ != 0; }
  friend constexpr auto operator<=>(const Handle&, const Handle&) = default;

 private:
  friend struct impl::HandleAccess;
  friend struct std::hash<Handle>;
  constexpr Handle(uint32_t index, uint32_t scene) : index_(index), scene_(scene) {}

  uint32_t index_ = 0xffffffffu;
  uint32_t scene_ = 0;
};

namespace part {
struct Mesh;
struct Image;
struct Texture;
struct Material;
struct Shape;
struct Group;
struct Instance;
struct Light;
}  // namespace part

using MeshId = Handle<part::Mesh>;
using ImageId = Handle<part::Image>;
using TextureId = Handle<part::Texture>;
using MaterialId = Handle<part::Material>;
using ShapeId = Handle<part::Shape>;
using GroupId = Handle<part::Group>;
using InstanceId = Handle<part::Instance>;
using LightId = Handle<part::Light>;

}  // namespace ALHAZEN_NAMESPACE

template <class Part>
struct std::hash<alhazen::Handle<Part>> {
  size_t operator()(const alhazen::Handle<Part>& handle) const noexcept {
    return std::hash<uint64_t>{}(uint64_t{handle.scene_} << 32 | handle.index_);
  }
};
