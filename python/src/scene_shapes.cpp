// The shapes, groups and instances of a scene.

#include "bind_part.h"
#include "described.h"
#include "mesh.h"
#include "value_bindings.h"

namespace alhazen::python {

const char* const shape_arguments_doc =
    "material: a material value, a SceneMaterial, the name of one, or None for a diffuse grey. transform: from object\n"
    "space to world space, or to that of the group: an array of the shape (4, 4), a Transform, or a MovingTransform.\n"
    "emission: None, a color (W / (m^2 sr)), a texture, or an Emission. reverse_orientation: flips normals, and so "
    "the\n"
    "emitting side. Shapes of one name are one object in layers.";

namespace {

std::optional<Emission> emission_of(py::handle given, alhazen::Scene& scene) {
  if (given.is_none()) return {};
  if (py::isinstance<Described<Emission>>(given))
    return *static_cast<const Emission*>(given.cast<const Value&>().resolved(scene)->data());
  if (const py::object texture = keep_texture("emission", given))
    return Emission{.texture = resolve_texture("emission", texture, scene)};
  return Emission{.radiance = colour("emission", given)};
}

/// Meshes that are not in the scene are added to it.
std::variant<Sphere, Cylinder, Disk, MeshId> geometry_of(py::handle given, alhazen::Scene& scene) {
  if (py::isinstance<Described<Sphere>>(given)) return given.cast<const Described<Sphere>&>().whole();
  if (py::isinstance<Described<Cylinder>>(given)) return given.cast<const Described<Cylinder>&>().whole();
  if (py::isinstance<Described<Disk>>(given)) return given.cast<const Described<Disk>&>().whole();
  if (py::isinstance<SceneMesh>(given)) return given.cast<const SceneMesh&>().id;
  if (const auto mesh = mesh_like(given)) return scene.add(mesh->arrays());
  refuse_given("geometry", "a Mesh, a SceneMesh, a Sphere, a Cylinder or a Disk", given);
}

py::object shown_geometry(const SceneShape& shape) {
  const auto geometry = shape.scene->read().shape(shape.id).geometry;
  return std::visit(
      [&]<class Kind>(const Kind& kind) -> py::object {
        if constexpr (std::is_same_v<Kind, MeshId>)
          return py::cast(SceneMesh(shape.scene, kind));
        else
          return py::cast(Described<Kind>(kind).frozen());
      },
      geometry);
}

template <class Change>
void change_shape(const SceneShape& self, const Change& change) {
  alhazen::Scene& scene = self.scene->change();
  Shape shape = scene.shape(self.id);
  change(scene, shape);
  scene.set(self.id, shape);
}

template <class Change>
void change_instance(const SceneInstance& self, const Change& change) {
  alhazen::Scene& scene = self.scene->change();
  Instance instance = scene.instance(self.id);
  change(instance);
  scene.set(self.id, instance);
}

const Transform start_of(const SceneShape& self) { return self.scene->read().shape(self.id).transform.start; }
const Transform start_of(const SceneInstance& self) { return self.scene->read().instance(self.id).transform.start; }
MovingTransform moving(const SceneShape& self) { return self.scene->read().shape(self.id).transform; }
MovingTransform moving(const SceneInstance& self) { return self.scene->read().instance(self.id).transform; }

template <class Placed, class... Options>
void bind_placed(py::class_<Placed, Options...>& bound) {
  bound
      .def_property(
          "transform", [](const Placed& self) { return shown(start_of(self)); },
          [](const Placed& self, const py::object& given) {
            self.scene->change().set_transform(self.id, moving_transform("transform", given));
          },
          "To the space that it is in, when the shutter opens: a read-only array of the shape (4, 4). Set an array or "
          "a\n"
          "Transform, and it does not move, or a MovingTransform.")
      .def_property(
          "end_transform", [](const Placed& self) { return shown(moving(self).end); },
          [](const Placed& self, const py::object& given) {
            const Transform end = transform("end_transform", given);
            self.scene->change().set_transform(self.id, MovingTransform(start_of(self), end));
          },
          "The same when the shutter closes.")
      .def_property_readonly(
          "is_moving", [](const Placed& self) { return moving(self).is_moving(); },
          "Whether transform and end_transform differ.")
      .def(
          "remove", [](const Placed& self) { self.scene->change().remove(self.id); },
          "Removes it from its scene. InputError: it was removed before.");
}

void bind_shape(py::module_& m) {
  py::class_<SceneShape> bound(
      m, "SceneShape",
      "A shape of a scene: a mesh or a quadric, where it is, and of what. Setting an attribute\n"
      "changes the scene.");
  bind_part<SceneShape>(bound, [](const SceneShape& self, const std::string& name) {
    change_shape(self, [&](alhazen::Scene&, Shape& shape) { shape.name = name; });
  });
  bind_placed(bound);
  bound
      .def_property(
          "geometry", &shown_geometry,
          [](const SceneShape& self, const py::object& given) {
            change_shape(self,
                         [&](alhazen::Scene& scene, Shape& shape) { shape.geometry = geometry_of(given, scene); });
          },
          "A SceneMesh, or a copy of a Sphere, Cylinder or Disk.")
      .def_property(
          "material",
          [](const SceneShape& self) {
            return part_object<SceneMaterial>(self.scene, self.scene->read().shape(self.id).material);
          },
          [](const SceneShape& self, const py::object& given) {
            alhazen::Scene& scene = self.scene->change();
            scene.shape(self.id);  // throws before a material is added
            scene.set_material(self.id, material_of("material", given, scene));
          },
          "A SceneMaterial, or None for a diffuse grey. A value is added to the scene, and a str names one of it.")
      .def_property(
          "emission",
          [](const SceneShape& self) -> py::object {
            const auto emission = self.scene->read().shape(self.id).emission;
            return emission ? py::cast(value_of<Emission>(self.scene, *emission)->frozen()) : py::none();
          },
          [](const SceneShape& self, const py::object& given) {
            change_shape(self,
                         [&](alhazen::Scene& scene, Shape& shape) { shape.emission = emission_of(given, scene); });
          },
          "An Emission, or None for a shape that is no light. A color or a texture can be set, too.")
      .def_property(
          "reverse_orientation",
          [](const SceneShape& self) { return self.scene->read().shape(self.id).reverse_orientation; },
          [](const SceneShape& self, const py::object& given) {
            const bool is_reversed = flag("reverse_orientation", given);
            change_shape(self, [&](alhazen::Scene&, Shape& shape) { shape.reverse_orientation = is_reversed; });
          },
          "bool: normals, and so the emitting side, are flipped.")
      .def_property_readonly(
          "group",
          [](const SceneShape& self) {
            return part_object<SceneGroup>(self.scene, self.scene->read().group_of(self.id));
          },
          "The SceneGroup that it is in, or None if it is in the world.")
      .def("__repr__", [](const SceneShape& self) {
        std::string kind;
        try {
          kind = ": " + std::string(py::str(py::repr(shown_geometry(self))));
        } catch (const Error&) {
        }
        return part_repr(self, "SceneShape", kind);
      });
}

void bind_group(py::module_& m) {
  py::class_<SceneGroup> bound(m, "SceneGroup",
                               "A group of shapes. It is seen where it is instanced: scene.add(group, transform=...).");
  bind_part<SceneGroup>(bound, {});
  py::options options;
  options.disable_function_signatures();
  bound
      .def(
          "add",
          [](const SceneGroup& self, const py::object& geometry, const py::kwargs& arguments) {
            return add_shape(self.scene, self.id, geometry, arguments);
          },
          py::arg("geometry"),
          (std::string("add(geometry, *, material=None, transform=None, emission=None, reverse_orientation=False, "
                       "name='') -> SceneShape\n\nAdds a shape to the group.\n\n") +
           shape_arguments_doc)
              .c_str())
      .def_property_readonly(
          "shapes",
          [](const SceneGroup& self) {
            py::list shapes;
            for (const ShapeId shape : self.scene->read().shapes())
              if (self.scene->read().group_of(shape) == self.id) shapes.append(SceneShape(self.scene, shape));
            return shapes;
          },
          "The shapes in it: a list of SceneShape.")
      .def("__repr__", [](const SceneGroup& self) { return part_repr(self, "SceneGroup"); });
}

void bind_instance(py::module_& m) {
  py::class_<SceneInstance> bound(m, "SceneInstance", "A group of shapes, placed once more.");
  bind_part<SceneInstance>(bound, [](const SceneInstance& self, const std::string& name) {
    change_instance(self, [&](Instance& instance) { instance.name = name; });
  });
  bind_placed(bound);
  bound
      .def_property(
          "group",
          [](const SceneInstance& self) { return SceneGroup(self.scene, self.scene->read().instance(self.id).group); },
          [](const SceneInstance& self, const py::object& given) {
            if (!py::isinstance<SceneGroup>(given)) refuse_given("group", "a SceneGroup", given);
            change_instance(self, [&](Instance& instance) { instance.group = given.cast<const SceneGroup&>().id; });
          },
          "The SceneGroup that is placed.")
      .def_property(
          "reverse_orientation",
          [](const SceneInstance& self) { return self.scene->read().instance(self.id).reverse_orientation; },
          [](const SceneInstance& self, const py::object& given) {
            const bool is_reversed = flag("reverse_orientation", given);
            change_instance(self, [&](Instance& instance) { instance.reverse_orientation = is_reversed; });
          },
          "bool: normals are flipped.")
      .def("__repr__", [](const SceneInstance& self) { return part_repr(self, "SceneInstance"); });
}

/// Calls `take` for each argument, which returns whether it knows the name.
template <class Take>
void take_arguments(const char* function, const char* names, const py::kwargs& arguments, const Take& take) {
  for (const auto& [key, given] : arguments)
    if (!take(std::string(py::str(key)), given))
      throw py::type_error(std::string(function) + " has no argument '" + std::string(py::str(key)) + "'; it has " +
                           names);
}

}  // namespace

bool is_geometry(py::handle given) {
  return py::isinstance<Described<Sphere>>(given) || py::isinstance<Described<Cylinder>>(given) ||
         py::isinstance<Described<Disk>>(given) || py::isinstance<SceneMesh>(given) ||
         py::isinstance<PythonMesh>(given) || (py::hasattr(given, "vertices") && py::hasattr(given, "faces"));
}

py::object add_shape(const std::shared_ptr<PythonScene>& scene, GroupId group, const py::object& geometry,
                     const py::kwargs& arguments) {
  alhazen::Scene& changed = scene->change();
  if (!is_geometry(geometry)) geometry_of(geometry, changed);  // throws
  Shape shape;
  // Numbers and texts first: what they refuse adds nothing.
  py::object material = py::none(), emission = py::none();
  take_arguments("add()", "material, transform, emission, reverse_orientation and name", arguments,
                 [&](const std::string& name, py::handle given) {
                   if (name == "material")
                     material = py::reinterpret_borrow<py::object>(given);
                   else if (name == "emission")
                     emission = py::reinterpret_borrow<py::object>(given);
                   else if (name == "transform" && !given.is_none())
                     shape.transform = moving_transform("transform", given);
                   else if (name == "reverse_orientation")
                     shape.reverse_orientation = flag("reverse_orientation", given);
                   else if (name == "name")
                     shape.name = text("name", given);
                   return name == "material" || name == "emission" || name == "transform" ||
                          name == "reverse_orientation" || name == "name";
                 });
  shape.emission = emission_of(emission, changed);
  shape.material = material_of("material", material, changed);
  shape.geometry = geometry_of(geometry, changed);
  return py::cast(SceneShape(scene, scene->change().add(shape, group)));
}

py::object add_instance(const std::shared_ptr<PythonScene>& scene, GroupId group, const py::kwargs& arguments) {
  Instance instance;
  instance.group = group;
  take_arguments("add() of a group", "transform, reverse_orientation and name", arguments,
                 [&](const std::string& name, py::handle given) {
                   if (name == "transform" && !given.is_none())
                     instance.transform = moving_transform("transform", given);
                   else if (name == "reverse_orientation")
                     instance.reverse_orientation = flag("reverse_orientation", given);
                   else if (name == "name")
                     instance.name = text("name", given);
                   return name == "transform" || name == "reverse_orientation" || name == "name";
                 });
  return py::cast(SceneInstance(scene, scene->change().add(instance)));
}

void bind_scene_shapes(py::module_& m) {
  bind_shape(m);
  bind_group(m);
  bind_instance(m);
}

}  // namespace alhazen::python
