// scene.materials, scene.shapes and so on: the parts of a kind, by position and by name.

#include <algorithm>
#include <vector>

#include "bind_part.h"

namespace alhazen::python {

namespace {

/// What a list knows of its parts.
template <class AnyPart>
struct Kind;

#define ALHAZEN_PYTHON_PARTS(AnyPart, list_name, noun)                                   \
  template <>                                                                            \
  struct Kind<AnyPart> {                                                                 \
    static constexpr const char *name = #list_name, *one = noun, *class_name = #AnyPart; \
    static auto all(const alhazen::Scene& scene) { return scene.list_name(); }           \
  }
ALHAZEN_PYTHON_PARTS(SceneMesh, meshes, "mesh");
ALHAZEN_PYTHON_PARTS(SceneImage, images, "image");
ALHAZEN_PYTHON_PARTS(SceneTexture, textures, "texture");
ALHAZEN_PYTHON_PARTS(SceneMaterial, materials, "material");
ALHAZEN_PYTHON_PARTS(SceneShape, shapes, "shape");
ALHAZEN_PYTHON_PARTS(SceneGroup, groups, "group");
ALHAZEN_PYTHON_PARTS(SceneInstance, instances, "instance");
ALHAZEN_PYTHON_PARTS(SceneLight, lights, "light");
#undef ALHAZEN_PYTHON_PARTS

/// Lives as long as the scene, and shows it as it is.
template <class AnyPart>
struct Parts {
  std::shared_ptr<PythonScene> scene;

  auto all() const { return Kind<AnyPart>::all(scene->read()); }
};

template <class AnyPart>
std::vector<AnyPart> found(const Parts<AnyPart>& self, const std::string& name) {
  const alhazen::Scene& scene = self.scene->read();
  std::vector<AnyPart> result;
  if constexpr (std::is_same_v<AnyPart, SceneShape>) {
    for (const ShapeId id : scene.find_shapes(name)) result.emplace_back(self.scene, id);
  } else if constexpr (std::is_same_v<AnyPart, SceneInstance>) {
    for (const InstanceId id : scene.find_instances(name)) result.emplace_back(self.scene, id);
  } else if constexpr (std::is_same_v<AnyPart, SceneLight>) {
    for (const LightId id : scene.find_lights(name)) result.emplace_back(self.scene, id);
  } else {
    for (const auto id : self.all())
      if (scene.name(id) == name) result.emplace_back(self.scene, id);
  }
  return result;
}

[[noreturn]] void raise_key_error(const std::string& message) {
  PyErr_SetString(PyExc_KeyError, message.c_str());
  throw py::error_already_set();
}

template <class AnyPart>
std::string names_text(const Parts<AnyPart>& self) {
  constexpr size_t most = 10;
  std::string list;
  size_t count = 0;
  for (const auto id : self.all()) {
    if (count++ == most) return list + ", ...";
    list += (count == 1 ? "" : ", ") + std::string(py::str(py::repr(path_text(self.scene->read().name(id)))));
  }
  return list.empty() ? "there are none" : "there are " + list;
}

template <class AnyPart>
AnyPart at(const Parts<AnyPart>& self, const py::object& key) {
  if (PyUnicode_Check(key.ptr())) {
    const std::string name = text("name", key);
    std::vector<AnyPart> named = found(self, name);
    const std::string shown = py::str(py::repr(key));
    if (named.empty())
      raise_key_error("no " + std::string(Kind<AnyPart>::one) + " is called " + shown + ": " + names_text(self));
    if (named.size() > 1)
      raise_key_error(std::to_string(named.size()) + " " + Kind<AnyPart>::name + " are called " + shown + ": find(" +
                      shown + ") returns all of them");
    return named.front();
  }
  if (!PyIndex_Check(key.ptr()) || PyBool_Check(key.ptr()))
    throw py::type_error("the " + std::string(Kind<AnyPart>::name) + " of a scene are found by an int or a name, not " +
                         short_repr(key));
  const auto ids = self.all();
  const auto count = static_cast<Py_ssize_t>(ids.size());
  Py_ssize_t index = PyNumber_AsSsize_t(key.ptr(), PyExc_IndexError);
  if (index == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (index < 0) index += count;
  if (index < 0 || index >= count)
    throw py::index_error("the scene has " + std::to_string(count) + " " + Kind<AnyPart>::name);
  return AnyPart(self.scene, ids[static_cast<size_t>(index)]);
}

template <class AnyPart>
bool contains(const Parts<AnyPart>& self, const py::object& key) {
  if (PyUnicode_Check(key.ptr())) return !found(self, text("name", key)).empty();
  if (!py::isinstance<AnyPart>(key)) return false;
  const auto& part = key.cast<const AnyPart&>();
  const auto ids = self.all();
  return part.scene == self.scene && std::find(ids.begin(), ids.end(), part.id) != ids.end();
}

template <class AnyPart>
py::list as_list(const Parts<AnyPart>& self) {
  py::list result;
  for (const auto id : self.all()) result.append(AnyPart(self.scene, id));
  return result;
}

template <class AnyPart>
void bind_list(py::module_& m) {
  const std::string one = Kind<AnyPart>::one, name = Kind<AnyPart>::name, class_name = Kind<AnyPart>::class_name;
  py::class_<Parts<AnyPart>> bound(m, (class_name + "List").c_str(),
                                   ("The " + name + " of a scene, as they are now: scene." + name + "[0], scene." +
                                    name + "['name'], and iteration.")
                                       .c_str());
  py::options options;
  options.disable_function_signatures();
  bound.def("__len__", [](const Parts<AnyPart>& self) { return self.all().size(); })
      .def("__iter__", [](const Parts<AnyPart>& self) { return py::iter(as_list(self)); })
      .def("__reversed__",
           [](const Parts<AnyPart>& self) { return py::module_::import("builtins").attr("reversed")(as_list(self)); })
      .def("__contains__", &contains<AnyPart>)
      .def("__getitem__", &at<AnyPart>, py::arg("key"),
           ("__getitem__(self, key: int | str) -> " + class_name +
            "\n\nKeyError: none, or more than one, is called so. IndexError: there are not as many.")
               .c_str())
      .def(
          "find",
          [](const Parts<AnyPart>& self, const py::object& wanted) {
            py::list parts;
            for (const AnyPart& part : found(self, text("name", wanted))) parts.append(part);
            return parts;
          },
          py::arg("name"), ("find(name: str) -> list[" + class_name + "]\n\nAll of that name.").c_str())
      .def(
          "get",
          [](const Parts<AnyPart>& self, const py::object& wanted, const py::object& otherwise) -> py::object {
            const std::vector<AnyPart> named = found(self, text("name", wanted));
            return named.empty() ? otherwise : py::cast(named.front());
          },
          py::arg("name"), py::arg("default") = py::none(),
          ("get(name: str, default=None) -> " + class_name + "\n\nThe first of that name, or the default.").c_str())
      .def(
          "names",
          [](const Parts<AnyPart>& self) {
            py::list names;
            for (const auto id : self.all()) names.append(path_text(self.scene->read().name(id)));
            return names;
          },
          "names() -> list[str]\n\nThe names of all, in the same order.")
      .def("__repr__", [name](const Parts<AnyPart>& self) {
        return "<" + std::to_string(self.all().size()) + " " + name + ": " + names_text(self) + ">";
      });
}

template <class AnyPart>
void add_list(SceneClass& scene, const char* doc) {
  scene.def_property_readonly(
      Kind<AnyPart>::name, [](const std::shared_ptr<PythonScene>& self) { return Parts<AnyPart>{self}; }, doc);
}

}  // namespace

void bind_scene_lists(py::module_& m) {
  bind_list<SceneMesh>(m);
  bind_list<SceneImage>(m);
  bind_list<SceneTexture>(m);
  bind_list<SceneMaterial>(m);
  bind_list<SceneShape>(m);
  bind_list<SceneGroup>(m);
  bind_list<SceneInstance>(m);
  bind_list<SceneLight>(m);
}

void bind_lists_of(SceneClass& scene) {
  add_list<SceneMesh>(scene, "All meshes, by position or name.");
  add_list<SceneImage>(scene, "All images of textures, by position or name.");
  add_list<SceneTexture>(scene, "All textures, by position or name, without the constants that are inputs of others.");
  add_list<SceneMaterial>(scene, "All materials, by position or name: scene.materials['clay'].base_color = (1, 0, 0).");
  add_list<SceneShape>(scene, "All shapes, of the world, then of the groups, by position or name.");
  add_list<SceneGroup>(scene, "All groups, by position or name.");
  add_list<SceneInstance>(scene, "All instances of groups, by position or name.");
  add_list<SceneLight>(scene, "All lights that are not shapes, by position or name.");
}

}  // namespace alhazen::python
