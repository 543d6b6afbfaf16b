// The textures, materials and lights of a scene.

#include "arrays.h"
#include "bind_part.h"
#include "image.h"

namespace alhazen::python {

namespace {

/// "<alhazen.SceneMaterial 'clay': Principled>".
template <class AnyPart>
std::string kind_repr(const AnyPart& self, const char* class_name) {
  std::string kind;
  try {
    kind = ": " + self.value()->value_class().name;
  } catch (const Error&) {
  }
  return part_repr(self, class_name, kind);
}

template <class AnyPart>
void rename_value(const AnyPart& part, const std::string& name) {
  const std::shared_ptr<Value> value = part.value();
  value->set(value->value_class().field("name"), path_text(name));
  part.set_value(*value);
}

template <class AnyPart>
py::class_<AnyPart, Live> bind_live_part(py::module_& m, const char* name, const char* doc) {
  py::class_<AnyPart, Live> bound(m, name, doc);
  bind_part<AnyPart>(bound, &rename_value<AnyPart>);
  bound.def("__repr__", [name](const AnyPart& self) { return kind_repr(self, name); });
  return bound;
}

py::object light_image(const SceneLight& light) {
  const Pixels pixels = light.scene->read().light_image(light.id);
  if (pixels.bytes.empty() && pixels.floats.empty()) return py::none();
  return copied_pixels(pixels);
}

}  // namespace

void bind_scene_materials(py::module_& m) {
  bind_live_part<SceneTexture>(m, "SceneTexture",
                               "A texture of a scene. It has the attributes of its kind, such as ImageTexture.scale.");
  bind_live_part<SceneMaterial>(
      m, "SceneMaterial",
      "A material of a scene. It has the attributes of its kind: scene.materials['clay'].base_color = (0.8, 0.3, 0.2)\n"
      "sets that of a Principled. All shapes that have the material change. Set `value` to make it of another kind:\n"
      "scene.materials['clay'].value = alhazen.Diffuse(0.5). What a file says and the classes cannot is kept.");
  bind_live_part<SceneLight>(m, "SceneLight",
                             "A light of a scene that is not a shape. It has the attributes of its kind, such as\n"
                             "PointLight.position.")
      .def_property(
          "image", &light_image,
          [](const SceneLight& self, const py::object& given) {
            const PythonImage image = image_of("image", given);
            alhazen::Scene& scene = self.scene->change();
            scene.set(self.id, scene.light(self.id), image.view("image"));
          },
          "The image of a goniometric, projection or environment light: a read-only copy of the shape (h, w, 3), or\n"
          "None. Arrays and Images of pixels can be set.")
      .def(
          "remove", [](const SceneLight& self) { self.scene->change().remove(self.id); },
          "Removes the light from its scene. InputError: it was removed before.");
}

}  // namespace alhazen::python
