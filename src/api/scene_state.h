#pragma once

// What a public Scene (include/alhazen/scene.h) owns: the description, which of its parts have handles, and what has
// changed.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/handles.h"
#include "files/input_record.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Counts the changes of each kind, so that a renderer knows what to build anew. Adding and removing parts counts too.
struct SceneRevisions {
  uint64_t geometry = 0;     ///< meshes; shapes, but for their transforms; which groups instances place
  uint64_t transforms = 0;   ///< of shapes and instances
  uint64_t materials = 0;    ///< materials and textures
  uint64_t images = 0;       ///< of textures
  uint64_t lights = 0;       ///< lights that are not infinite, their images, and the emission of shapes
  uint64_t environment = 0;  ///< infinite lights and their maps
  uint64_t light_maps = 0;   ///< environment maps and images of lights, which also count as changes of their lights
  uint64_t camera = 0;
  uint64_t film = 0;  ///< film, pixel filter, defaults of the render, and the way up

  friend bool operator==(const SceneRevisions&, const SceneRevisions&) = default;
};

/// Makes handles and takes them apart.
struct HandleAccess {
  template <class Id>
  static Id make(uint32_t index, uint32_t scene) {
    return Id(index, scene);
  }
  template <class Part>
  static uint32_t index(const Handle<Part>& handle) {
    return handle.index_;
  }
  template <class Part>
  static uint32_t scene(const Handle<Part>& handle) {
    return handle.scene_;
  }
};

/// Which scene added the parts of a kind: all from `first` on were added by `scene`, up to the next entry. A copy has
/// the entries of its original, and adds as a scene of its own, so that a handle from after the copy fits only one.
class PartOwners {
 public:
  explicit PartOwners(uint32_t scene) : owners_{{0, scene}} {}
  uint32_t of(uint32_t index) const;
  void add(uint32_t index, uint32_t scene);

 private:
  struct Owner {
    uint32_t first, scene;
  };
  std::vector<Owner> owners_;
};

/// How a texture node without inputs came about.
enum class ConstantUse : uint8_t {
  texture,  ///< it was added as a texture
  value,    ///< a file's value of some inputs; it is read as a value, and may be shared
  owned,    ///< the value of one input, which changes it in place
  unused    ///< was owned
};

/// The place of a shape in the description.
struct ShapePlace {
  uint32_t group = no_index;  ///< no_index: it was removed
  uint32_t index = 0;
};

struct SceneState {
  SceneState();
  /// Of a scene that was read.
  SceneState(Scene&& scene, const Diagnostics& diagnostics, std::shared_ptr<InputRecord> inputs_);
  /// A copy that adds parts as a scene of its own.
  SceneState(const SceneState& other);
  SceneState& operator=(const SceneState&) = delete;

  Scene description;
  SceneRevisions revisions;
  std::vector<Diagnostics::Warning> warnings;  ///< of the reader
  std::shared_ptr<InputRecord> inputs;         ///< files that must not be overwritten; may be null
  bool is_read = false;                        ///< from a file, which has its camera and lights

  uint32_t id = 0;  ///< of this scene, by which it gives handles
  PartOwners meshes, images, textures, materials, shapes, groups, instances, lights;
  /// By the index of a handle, for parts that can be removed.
  std::vector<ShapePlace> shape_places;
  std::vector<uint32_t> instance_places, light_places;  ///< no_index: it was removed
  std::vector<ConstantUse> constant_uses;               ///< by texture
  std::vector<uint32_t> unused_constants;               ///< textures

  /// The description that is compiled: completed by a camera and light where it has none, with meshes for quadrics that
  /// are not exact where they are. `aspect` is that of the image that is asked for, 0: of the film.
  Scene to_render(double aspect) const;

  /// The same of its outline (scene/outline.h), seen by that camera.
  Scene outline_to_render(const Camera& camera, bool with_light_maps) const;
};

/// The camera that sees the whole of a scene which has none of its own.
Camera default_camera(const Scene& scene, double aspect);

}  // namespace alhazen::impl
