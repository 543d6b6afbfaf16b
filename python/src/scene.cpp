// alhazen.Scene as a whole, and load.

#include "alhazen/scene.h"

#include "convert.h"
#include "interruptible.h"
#include "parts.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

using ScenePointer = std::shared_ptr<PythonScene>;

std::string count_text(size_t count, const char* one, const char* many) {
  return ", " + std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string scene_text(const PythonScene& self) {
  const alhazen::Scene& scene = self.read();
  std::string text = "<alhazen.Scene";
  if (const std::string file = scene.file(); !file.empty())
    text += " " + std::string(py::str(py::repr(path_text(file))));
  const size_t instances = scene.instances().size();
  std::string counts = count_text(scene.shapes().size(), "shape", "shapes");
  if (instances > 0) counts += count_text(instances, "instance", "instances");
  counts += count_text(scene.materials().size(), "material", "materials");
  counts += count_text(scene.lights().size(), "light", "lights");
  return text + ": " + counts.substr(2) + ">";
}

ScenePointer copy(const PythonScene& self) {
  const SceneReading reading(self);
  const Unlocked unlocked;
  return std::make_shared<PythonScene>(alhazen::Scene(reading.scene()));
}

/// A name, or a number from 0.
std::string choice(const char* name, const py::object& given) {
  if (given.is_none()) return {};
  if (PyUnicode_Check(given.ptr())) return text(name, given);
  return std::to_string(integer(name, given, 0, 1'000'000'000));
}

std::optional<double> optional_number(const char* name, const py::object& given) {
  if (given.is_none()) return {};
  return number(name, given);
}

std::vector<std::string> definitions_of(const py::object& given) {
  std::vector<std::string> definitions;
  if (given.is_none()) return definitions;
  if (PyDict_Check(given.ptr())) {
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given))
      definitions.push_back(text("definitions", key) + "=" + text("definitions", py::str(value)));
    return definitions;
  }
  if (!is_sequence(given)) refuse_given("definitions", "a dict, or a list of 'NAME=VALUE'", given);
  for (const py::handle definition : given) definitions.push_back(text("definitions", definition));
  return definitions;
}

std::vector<std::string> folders_of(const py::object& given) {
  std::vector<std::string> folders;
  if (given.is_none()) return folders;
  if (is_file_name(given)) return {file_name("search_paths", given)};
  if (!is_sequence(given)) refuse_given("search_paths", "a list of folders", given);
  for (const py::handle folder : given) folders.push_back(file_name("search_paths", folder));
  return folders;
}

ScenePointer load(const py::object& file, const py::object& camera, const py::object& variant,
                  const py::object& animation, const py::object& time, const py::object& shutter,
                  const py::object& frames_per_second, const py::object& definitions, const py::object& search_paths,
                  const py::object& confine, const py::object& strict) {
  const std::string name = file_name("file", file);
  const LoadOptions options{.camera = choice("camera", camera),
                            .variant = choice("variant", variant),
                            .animation = choice("animation", animation),
                            .time = optional_number("time", time),
                            .shutter = optional_number("shutter", shutter),
                            .frames_per_second = number("frames_per_second", frames_per_second),
                            .definitions = definitions_of(definitions),
                            .search_paths = folders_of(search_paths),
                            .confine = flag("confine", confine),
                            .strict = flag("strict", strict)};
  const Unlocked unlocked;
  return std::make_shared<PythonScene>(alhazen::Scene::load(name, options));
}

constexpr const char* load_doc =
    "load(file: str | os.PathLike, *, camera: str | int | None = None, variant: str | int | None = None, animation: "
    "str | "
    "int | None = None, time: float | None = None, shutter: float | None = None, frames_per_second: float = 24, "
    "definitions: dict | list[str] | None = None, search_paths: list[str] | None = None, confine: bool = False, "
    "strict: "
    "bool = False) -> Scene\n\n"
    "Reads a scene (.pbrt, .gltf, .glb, .xml of Mitsuba) or a model (.obj, .ply, .stl).\n\n"
    "camera, variant: glTF, a name or a number from 0. animation: glTF, likewise; time: seconds, the scene at this "
    "time\n"
    "of its animation. shutter: motion blur, the fraction of the time of a frame for which the shutter is open, 0 to "
    "1,\n"
    "of frames_per_second. definitions: Mitsuba, values for $NAME. search_paths: folders in which files are looked "
    "for\n"
    "after the scene's own. confine: no files outside the folder of the scene. strict: a texture image that is "
    "missing\n"
    "is an error, not a warning.\n\n"
    "InputError has the file, line and column of what cannot be read; it is a FileNotFoundError as well if there is "
    "no\n"
    "such file. What the reader warns of is in scene.warnings. Other threads of Python run meanwhile.";

}  // namespace

void bind_scene(py::module_& m) {
  SceneClass scene(
      m, "Scene",
      "A scene: made in memory from arrays, or read from a file by load, then looked at and changed, and rendered.\n\n"
      "    scene = alhazen.Scene()\n"
      "    scene.add(alhazen.Mesh(vertices, faces), material=alhazen.Principled(base_color=(0.8, 0.3, 0.2)))\n"
      "    scene.camera.look_at((0, 1, 3), (0, 0, 0))\n\n"
      "Lengths are in the scene's unit, angles in degrees, colors linear sRGB. The world is right-handed; y is upwards "
      "in\n"
      "a new one. Until a camera is given, a new scene is seen as a whole, from the front, the side and above; as long "
      "as\n"
      "it has no light at all, it is lit by neutral light from everywhere.\n\n"
      "copy.copy and copy.deepcopy make a copy that shares nothing. Parts keep their scene alive. While another "
      "thread\n"
      "renders a scene, changing it raises Error.");
  bind_live(m);
  bind_scene_materials(m);
  bind_scene_meshes(m);
  bind_scene_shapes(m);
  bind_scene_lists(m);
  bind_scene_views(m);
  py::options options;
  options.disable_function_signatures();
  scene.def(py::init<>(), "__init__(self)\n\nA scene with nothing in it.")
      .def("__repr__", &scene_text)
      .def("copy", &copy,
           "copy() -> Scene\n\nA copy that shares nothing with it. Parts of it name those of the copy, too.")
      .def("__copy__", &copy)
      .def("__deepcopy__", [](const PythonScene& self, const py::object&) { return copy(self); })
      .def_property_readonly(
          "warnings",
          [](const PythonScene& self) {
            py::list texts;
            for (const auto& warning : self.read().warnings()) texts.append(path_text(warning.text()));
            return texts;
          },
          "What the reader of the file warned of, each with its place: a list of str.")
      .def_property_readonly(
          "file",
          [](const PythonScene& self) -> py::object {
            const std::string file = self.read().file();
            if (file.empty()) return py::none();
            return path_text(file);
          },
          "The name of the file that it was read from, or None.")
      .def_property_readonly(
          "bounds", [](const PythonScene& self) { return self.read().bounds(); },
          "The Box of all shapes and instances in world space when the shutter opens; empty if there are none.")
      .def_property(
          "up", [](const PythonScene& self) { return shown(self.read().up()); },
          [](PythonScene& self, const py::object& up) {
            const Vec3 direction = vector3("up", up);
            self.change().set_up(direction);
          },
          "The direction upwards in world space, for look_at, orbit and the default view; (0, 0, 0): the file does not "
          "say.");
  bind_lists_of(scene);
  bind_views_of(scene);
  bind_adding_to(scene);
  m.def("load", &load, py::arg("file"), py::kw_only(), py::arg("camera") = py::none(), py::arg("variant") = py::none(),
        py::arg("animation") = py::none(), py::arg("time") = py::none(), py::arg("shutter") = py::none(),
        py::arg("frames_per_second") = 24.0, py::arg("definitions") = py::none(), py::arg("search_paths") = py::none(),
        py::arg("confine") = false, py::arg("strict") = false, load_doc);
}

}  // namespace alhazen::python
