#pragma once

// What Python has of the parts of a scene: the scene, which it keeps alive, and the handle.

#include <memory>
#include <string>

#include "alhazen/error.h"
#include "alhazen/handles.h"
#include "alhazen/scene.h"
#include "python_scene.h"
#include "value.h"

namespace alhazen::python {

/// Something whose attributes are those of a value that the scene has.
class Live {
 public:
  virtual ~Live() = default;
  virtual std::shared_ptr<Value> value() const = 0;
  /// Adds what the value refers to.
  virtual void set_value(const Value& value) const = 0;
};

template <class Id>
struct Part {
  Part(std::shared_ptr<PythonScene> of_scene, Id with_id) : scene(std::move(of_scene)), id(with_id) {}
  std::shared_ptr<PythonScene> scene;
  Id id;
};

struct SceneMesh : Part<MeshId> {
  using Part::Part;
};
struct SceneImage : Part<ImageId> {
  using Part::Part;
};
struct SceneShape : Part<ShapeId> {
  using Part::Part;
};
struct SceneGroup : Part<GroupId> {
  using Part::Part;
};
struct SceneInstance : Part<InstanceId> {
  using Part::Part;
};
struct SceneTexture : Live, Part<TextureId> {
  using Part::Part;
  std::shared_ptr<Value> value() const override;
  void set_value(const Value& value) const override;
};
struct SceneMaterial : Live, Part<MaterialId> {
  using Part::Part;
  std::shared_ptr<Value> value() const override;
  void set_value(const Value& value) const override;
};
struct SceneLight : Live, Part<LightId> {
  using Part::Part;
  std::shared_ptr<Value> value() const override;
  void set_value(const Value& value) const override;
};

/// The part of a handle, None for one that names nothing.
template <class AnyPart, class Id>
py::object part_object(const std::shared_ptr<PythonScene>& scene, Id id) {
  if (!id) return py::none();
  return py::cast(AnyPart(scene, id));
}

// What is given for a part: one of the scene, or a value, which is added to it. -------------------------------------

/// None: none; a str: the name of one in the scene.
MaterialId material_of(const std::string& name, py::handle given, alhazen::Scene& scene);
/// A value's struct, its parts added to the scene. Throws InputError unless `given` is a value of that family.
std::shared_ptr<Value> resolved_texture(const std::string& name, py::handle given, alhazen::Scene& scene);

/// The name as layers and reports have it; empty for a part that was removed.
template <class AnyPart>
std::string name_or_empty(const AnyPart& part) {
  try {
    return part.scene->read().name(part.id);
  } catch (const Error&) {
    return {};
  }
}

// Each binds some classes. --------------------------------------------------------------------------------------------

void bind_live(py::module_& m);
void bind_scene_materials(py::module_& m);
void bind_scene_meshes(py::module_& m);
void bind_scene_shapes(py::module_& m);
void bind_scene_lists(py::module_& m);
void bind_scene_views(py::module_& m);

/// The attributes of scenes that are lists of parts, and live views.
using SceneClass = py::class_<PythonScene, std::shared_ptr<PythonScene>>;
void bind_lists_of(SceneClass& scene);
void bind_views_of(SceneClass& scene);
void bind_adding_to(SceneClass& scene);

/// What scene.add and group.add do with a shape's arguments.
py::object add_shape(const std::shared_ptr<PythonScene>& scene, GroupId group, const py::object& geometry,
                     const py::kwargs& arguments);
py::object add_instance(const std::shared_ptr<PythonScene>& scene, GroupId group, const py::kwargs& arguments);
/// Null if it is neither mesh nor quadric.
bool is_geometry(py::handle given);
extern const char* const shape_arguments_doc;

}  // namespace alhazen::python
