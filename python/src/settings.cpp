#include "settings.h"

#include <memory>
#include <utility>

#include "setting_fields.h"

namespace alhazen::python {

namespace {

const SettingField* field_named(const std::string& name) {
  for (const SettingField& field : setting_fields())
    if (name == field.name) return &field;
  return nullptr;
}

/// `; did you mean 'spp'?`, or nothing.
std::string suggestion(const std::string& name) {
  py::list names;
  for (const SettingField& field : setting_fields()) names.append(field.name);
  const py::list close = py::module_::import("difflib").attr("get_close_matches")(name, names, 1);
  return close.empty() ? std::string() : "; did you mean '" + py::cast<std::string>(close[0]) + "'?";
}

/// The fields that differ from the defaults, without aliases.
py::dict changed_fields(const alhazen::Settings& settings) {
  const alhazen::Settings defaults;
  py::dict changed;
  for (const SettingField& field : setting_fields()) {
    if (field.is_alias) continue;
    const py::object value = field.get(settings);
    if (!value.equal(field.get(defaults))) changed[field.name] = value;
  }
  return changed;
}

std::string text_of(const alhazen::Settings& settings) {
  std::string text;
  for (const auto& [name, value] : changed_fields(settings))
    text += (text.empty() ? "" : ", ") + py::cast<std::string>(name) + "=" + py::cast<std::string>(py::repr(value));
  return "alhazen.Settings(" + text + ")";
}

}  // namespace

alhazen::Settings settings_of(const std::string& function, const py::object& base, const py::dict& keywords) {
  if (!base.is_none() && !py::isinstance<alhazen::Settings>(base))
    throw py::type_error(function + "() takes an alhazen.Settings as 'settings', not " +
                         py::cast<std::string>(py::type::handle_of(base).attr("__name__")));
  alhazen::Settings settings = base.is_none() ? alhazen::Settings() : py::cast<const alhazen::Settings&>(base);
  for (const auto& [key, value] : keywords) {
    const std::string name = py::cast<std::string>(key);
    const SettingField* field = field_named(name);
    if (field == nullptr)
      throw py::type_error(function + "() got an unexpected keyword argument '" + name + "'" + suggestion(name));
    field->set(settings, value);
  }
  return settings;
}

void bind_settings(py::module_& m) {
  using alhazen::Settings;
  py::options options;
  options.disable_function_signatures();
  py::class_<Settings> settings(
      m, "Settings",
      "How to render. Every setting is a keyword argument of the constructor and an attribute; what is left open "
      "comes\n"
      "from the scene or is chosen automatically. None stands for the default.\n\n"
      "The same keyword arguments are taken by alhazen.render, alhazen.progressive and alhazen.Renderer.\n\n"
      "Raises TypeError for unknown names, InputError for values of a wrong type or out of range.");
  settings.def(py::init([](const py::kwargs& keywords) { return settings_of("Settings", py::none(), keywords); }),
               "__init__(self, **keywords)");
  for (const SettingField& field : setting_fields()) {
    const std::string doc = std::string(field.type) + ": " + field.help;
    settings.def_property(
        field.name, [&field](const Settings& s) { return field.get(s); },
        [&field](Settings& s, const py::object& value) { field.set(s, value); }, doc.c_str());
  }
  settings
      .def(
          "replace",
          [](const py::object& self, const py::kwargs& keywords) {
            return settings_of("Settings.replace", self, keywords);
          },
          "replace(self, **keywords) -> Settings\n\nA copy in which these settings have other values.")
      .def("as_dict", &changed_fields,
           "as_dict(self) -> dict[str, object]\n\nThe settings that are not at their defaults, by name.")
      .def("__eq__",
           [](const Settings& a, const py::object& b) -> py::object {
             if (!py::isinstance<Settings>(b)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             return py::bool_(changed_fields(a).equal(changed_fields(py::cast<const Settings&>(b))));
           })
      .def("__repr__", &text_of)
      .def("__copy__", [](const Settings& s) { return Settings(s); })
      .def("__deepcopy__", [](const Settings& s, const py::dict&) { return Settings(s); })
      .def(py::pickle([](const Settings& s) { return changed_fields(s); },
                      [](const py::dict& changed) { return settings_of("Settings", py::none(), changed); }));
  settings.attr("__hash__") = py::none();
}

}  // namespace alhazen::python
