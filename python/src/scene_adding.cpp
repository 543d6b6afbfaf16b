// scene.add and its kin, and scene.environment.

#include "convert.h"
#include "described.h"
#include "image.h"
#include "interruptible.h"
#include "mesh.h"
#include "parts.h"

namespace alhazen::python {

namespace {

using ScenePointer = std::shared_ptr<PythonScene>;

/// Throws TypeError if there are arguments besides those that `allowed` names.
void check_no_more(const char* what, const py::kwargs& arguments, const char* allowed = "") {
  for (const auto& [key, value] : arguments) {
    const std::string name = py::str(key);
    if (name != allowed) throw py::type_error("add() of " + std::string(what) + " has no argument '" + name + "'");
  }
}

py::object add_light(const ScenePointer& scene, const py::object& light, const py::kwargs& arguments) {
  check_no_more("a light", arguments, "image");
  const Light& described = *static_cast<const Light*>(light.cast<const Value&>().data());
  if (!arguments.contains("image")) return py::cast(SceneLight(scene, scene->change().add(described)));
  const PythonImage image = image_of("image", arguments["image"]);
  return py::cast(SceneLight(scene, scene->change().add(described, image.view("image"))));
}

py::object add(const ScenePointer& scene, const py::object& what, const py::kwargs& arguments) {
  if (is_geometry(what)) return add_shape(scene, {}, what, arguments);
  if (py::isinstance<SceneGroup>(what)) return add_instance(scene, what.cast<const SceneGroup&>().id, arguments);
  if (py::isinstance<Family<Light>>(what)) return add_light(scene, what, arguments);
  if (py::isinstance<Family<Material>>(what)) {
    check_no_more("a material", arguments);
    return py::cast(SceneMaterial(scene, material_of("what", what, scene->change())));
  }
  if (py::isinstance<Family<Texture>>(what)) {
    check_no_more("a texture", arguments);
    return py::cast(SceneTexture(scene, resolve_texture("what", what, scene->change())));
  }
  if (py::isinstance<PythonImage>(what)) {
    check_no_more("an image", arguments);
    return py::cast(SceneImage(scene, add_image(what.cast<const PythonImage&>(), scene->change())));
  }
  refuse_given("what",
               "a shape (Mesh, SceneMesh, Sphere, Cylinder, Disk), a SceneGroup, a light, a material, a texture or an "
               "Image",
               what);
}

bool is_infinite(const Light& light) {
  return std::holds_alternative<ConstantInfiniteLight>(light.kind) ||
         std::holds_alternative<EnvironmentLight>(light.kind);
}

py::object environment(const ScenePointer& scene) {
  for (const LightId light : scene->read().lights())
    if (is_infinite(scene->read().light(light))) return py::cast(SceneLight(scene, light));
  return py::none();
}

/// What is neither an image nor a file: colour() says what is wrong with it.
bool is_colour(py::handle given) {
  if (is_file_name(given) || py::isinstance<PythonImage>(given)) return false;
  if (py::isinstance<py::array>(given)) return py::reinterpret_borrow<py::array>(given).ndim() <= 1;
  return !is_sequence(given) || py::len(given) == 0 || !is_sequence(py::object(given[py::int_(0)]));
}

void set_environment(const ScenePointer& scene, const py::object& given) {
  if (given.is_none()) {
    alhazen::Scene& changed = scene->change();
    for (const LightId light : changed.lights())
      if (is_infinite(changed.light(light))) changed.remove(light);
    return;
  }
  if (is_colour(given)) {
    const Colour radiance = colour("environment", given);
    scene->change().set_environment(radiance);
    return;
  }
  const PythonImage image = image_of("environment", given);
  if (image.pixels) {
    scene->change().set_environment(image.view("environment"));
    return;
  }
  const SceneChange change(*scene);
  const Unlocked unlocked;
  change.scene().load_environment(image.file);
}

constexpr const char* environment_doc =
    "Light from everywhere: a SceneLight, or None. Set a color (W / (m^2 sr)), an array or Image, or the name of an "
    "image\n"
    "file, which replaces all infinite lights; None removes them. Images are twice as wide as high (equirectangular) "
    "or\n"
    "square (equal-area octahedral); the top is towards +y, the centre towards -z; floats are linear, uint8 is sRGB. "
    "As\n"
    "long as a new scene has no light at all, neutral light comes from everywhere; 0 makes it dark.";

}  // namespace

void bind_adding_to(SceneClass& scene) {
  py::options options;
  options.disable_function_signatures();
  scene
      .def(
          "add", &add, py::arg("what"),
          (std::string(
               "add(what, **arguments) -> SceneShape | SceneInstance | SceneLight | SceneMaterial | SceneTexture | "
               "SceneImage\n\n"
               "Adds a copy of it to the scene, and returns the part of the scene that it became.\n\n"
               "A Mesh, an object with vertices and faces (as of trimesh), a SceneMesh, Sphere, Cylinder or Disk "
               "becomes\n"
               "a shape: add(geometry, material=None, transform=None, emission=None, reverse_orientation=False,\n"
               "name=''). ") +
           shape_arguments_doc +
           "\n\n"
           "A SceneGroup is placed: add(group, transform=None, reverse_orientation=False, name=''). A light may need "
           "its\n"
           "image: add(light, image=array). Materials, textures and Images have no more arguments; a material that is\n"
           "added once can be that of many shapes.\n\n"
           "InputError names the argument that cannot be used; nothing is then added, but for materials, textures and\n"
           "images that were given along with it.")
              .c_str())
      .def(
          "add_mesh",
          [](const ScenePointer& self, const py::object& mesh) {
            const auto given = mesh_like(mesh);
            if (!given) refuse_given("mesh", "a Mesh", mesh);
            return SceneMesh(self, self->change().add(given->arrays()));
          },
          py::arg("mesh"),
          "add_mesh(mesh: Mesh) -> SceneMesh\n\n"
          "Adds a mesh without a shape of it, to make several of one: scene.add(scene_mesh, transform=...).")
      .def(
          "add_group",
          [](const ScenePointer& self, const py::object& name) {
            return SceneGroup(self, self->change().add_group(text("name", name)));
          },
          py::arg("name") = "",
          "add_group(name: str = '') -> SceneGroup\n\n"
          "A group without shapes: add them by group.add(...), then place it by scene.add(group, transform=...).")
      .def_property("environment", &environment, &set_environment, environment_doc);
}

}  // namespace alhazen::python
