// Attributes of materials, textures and lights of a scene, and the way from values to handles.

#include "convert.h"
#include "described.h"
#include "image.h"
#include "parts.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

template <class Whole>
const Whole& checked_whole(const char* name, const char* wanted, const Value& value) {
  if (dynamic_cast<const Family<Whole>*>(&value) == nullptr)
    refuse_given(name, wanted, py::cast(const_cast<Value&>(value).shared_from_this()));
  return *static_cast<const Whole*>(value.data());
}

/// What is set may refer to parts of the scene that change() gives; names of attributes of the class come first.
void set_attribute(py::handle self, const std::string& name, py::handle given) {
  const std::string spelled = american(name);
  if (py::hasattr(py::type::of(self), spelled.c_str())) {
    if (PyObject_GenericSetAttr(self.ptr(), py::str(spelled).ptr(), given.ptr()) != 0) throw py::error_already_set();
    return;
  }
  const Live& live = self.cast<const Live&>();
  const std::shared_ptr<Value> value = live.value();
  const Field* field = value->value_class().find(spelled);
  if (field == nullptr)
    throw py::attribute_error("this " + value->value_class().name + " has no attribute '" + name + "'");
  value->set(*field, given);
  live.set_value(*value);
}

py::object attribute(const Live& self, const std::string& name) {
  // What Python itself asks for must not fail otherwise, even where the part was removed.
  if (name.starts_with("__")) throw py::attribute_error(name);
  const std::shared_ptr<Value> value = self.value();
  const Field* field = value->value_class().find(name);
  if (field == nullptr)
    throw py::attribute_error("this " + value->value_class().name + " has no attribute '" + name + "'");
  return value->get(*field);
}

py::list attribute_names(py::handle self) {
  const py::object names = py::module_::import("builtins").attr("object").attr("__dir__")(self);
  py::list all(names);
  for (const Field& field : self.cast<const Live&>().value()->value_class().fields) all.append(field.name);
  return all;
}

}  // namespace

std::shared_ptr<Value> SceneTexture::value() const { return texture_value(scene, scene->read().texture(id)); }

void SceneTexture::set_value(const Value& value) const {
  checked_whole<Texture>("value", "a texture", value);
  alhazen::Scene& changed = scene->change();
  changed.set(id, *static_cast<const Texture*>(value.resolved(changed)->data()));
}

std::shared_ptr<Value> SceneMaterial::value() const { return material_value(scene, scene->read().material(id)); }

void SceneMaterial::set_value(const Value& value) const {
  checked_whole<Material>("value", "a material", value);
  alhazen::Scene& changed = scene->change();
  changed.set(id, *static_cast<const Material*>(value.resolved(changed)->data()));
}

std::shared_ptr<Value> SceneLight::value() const { return light_value(scene, scene->read().light(id)); }

void SceneLight::set_value(const Value& value) const {
  scene->change().set(id, checked_whole<Light>("value", "a light", value));
}

py::object keep_texture(const std::string& name, py::handle given) {
  if (py::isinstance<Family<Texture>>(given)) return py::cast(given.cast<const Value&>().frozen());
  if (py::isinstance<SceneTexture>(given)) return py::reinterpret_borrow<py::object>(given);
  if (py::isinstance<PythonImage>(given) || py::isinstance<SceneImage>(given) || is_file_name(given))
    refuse_given(name, "a number, a color or a texture, which alhazen.ImageTexture(image) makes of an image", given);
  return {};
}

TextureId resolve_texture(const std::string& name, py::handle kept, alhazen::Scene& scene) {
  if (py::isinstance<SceneTexture>(kept)) return kept.cast<const SceneTexture&>().id;
  return scene.add(*static_cast<const Texture*>(resolved_texture(name, kept, scene)->data()));
}

py::object lift_texture(const std::shared_ptr<PythonScene>& scene, TextureId texture) {
  return py::cast(SceneTexture(scene, texture));
}

std::shared_ptr<Value> resolved_texture(const std::string& name, py::handle given, alhazen::Scene& scene) {
  if (!py::isinstance<Family<Texture>>(given)) refuse_given(name, "a texture", given);
  return given.cast<const Value&>().resolved(scene);
}

MaterialId material_of(const std::string& name, py::handle given, alhazen::Scene& scene) {
  if (given.is_none()) return {};
  if (py::isinstance<SceneMaterial>(given)) return given.cast<const SceneMaterial&>().id;
  if (PyUnicode_Check(given.ptr())) {
    const MaterialId found = scene.find_material(text(name, given));
    if (!found) refuse_given(name, "a material or the name of one that the scene has", given);
    return found;
  }
  if (!py::isinstance<Family<Material>>(given))
    refuse_given(name, "a material, such as alhazen.Principled(...), one of the scene, or None", given);
  return scene.add(*static_cast<const Material*>(given.cast<const Value&>().resolved(scene)->data()));
}

// The two materials of a mix.
// ------------------------------------------------------------------------------------------

using Pair = std::array<MaterialId, 2>;

Pair FieldType<Pair>::read(const std::string& name, py::handle given) {
  if (!given.is_none()) refuse_given(name, "two materials", given);
  return {};
}

py::object FieldType<Pair>::keep(const std::string& name, py::handle given) {
  if (given.is_none()) return {};
  if (!is_sequence(given) || py::len(given) != 2) refuse_given(name, "two materials", given);
  py::tuple kept(2);
  for (size_t i = 0; i < 2; ++i) {
    const py::object material = given[py::int_(i)];
    if (py::isinstance<SceneMaterial>(material))
      kept[i] = material;
    else if (py::isinstance<Family<Material>>(material))
      kept[i] = py::cast(material.cast<const Value&>().frozen());
    else
      refuse_given(name, "two materials", given);
  }
  return kept;
}

Pair FieldType<Pair>::resolve(const std::string& name, py::handle kept, alhazen::Scene& scene) {
  return {material_of(name, kept[py::int_(0)], scene), material_of(name, kept[py::int_(1)], scene)};
}

py::object FieldType<Pair>::lift(const std::shared_ptr<PythonScene>& scene, const Pair& materials) {
  if (!materials[0] || !materials[1]) return {};
  return py::make_tuple(SceneMaterial(scene, materials[0]), SceneMaterial(scene, materials[1]));
}

void bind_live(py::module_& m) {
  py::class_<Live>(
      m, "Live",
      "Something of a scene whose attributes are those of a value: reading one reads the scene, and setting\n"
      "one changes it at once.")
      .def_property(
          "value", [](const Live& self) { return self.value(); },
          [](const Live& self, const py::object& given) {
            if (py::isinstance<Live>(given)) return self.set_value(*given.cast<const Live&>().value());
            if (!py::isinstance<Value>(given)) refuse_given("value", "a value", given);
            self.set_value(given.cast<const Value&>());
          },
          "All of it: a copy, whose class says of which kind it is. Setting it replaces all, and perhaps the kind.")
      .def("__getattr__", &attribute)
      .def("__setattr__", &set_attribute)
      .def("__dir__", &attribute_names);
}

}  // namespace alhazen::python
