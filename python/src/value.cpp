#include "value.h"

#include "convert.h"

namespace alhazen::python {

namespace {

/// What is the same as the default is not shown. Arrays are compared as a whole.
bool same(py::handle a, py::handle b) {
  if (py::isinstance<py::array>(a) && py::isinstance<py::array>(b))
    return py::module_::import("numpy").attr("array_equal")(a, b).cast<bool>();
  return a.equal(b);
}

std::string shown_text(py::handle value) {
  if (py::isinstance<py::array>(value)) return py::str(py::repr(value.attr("tolist")()));
  return py::str(py::repr(value));
}

[[noreturn]] void raise_type_error(const std::string& message) { throw py::type_error(message); }

}  // namespace

std::string american(const std::string& name) {
  std::string result = name;
  for (size_t at = 0; (at = result.find("olour", at)) != std::string::npos;) result.replace(at, 5, "olor");
  return result;
}

const Field* ValueClass::find(const std::string& wanted) const {
  const std::string spelled = american(wanted);
  for (const Field& field : fields)
    if (field.name == spelled) return &field;
  return nullptr;
}

const Field& ValueClass::field(const std::string& wanted) const {
  if (const Field* found = find(wanted)) return *found;
  std::string names;
  for (const Field& field : fields) names += (names.empty() ? "" : ", ") + field.name;
  raise_type_error(name + " has no '" + wanted + "'; it has " + names);
}

py::object Value::get(const Field& field) const {
  if (const auto kept = kept_.find(&field); kept != kept_.end()) return kept->second;
  return field.show(data());
}

void Value::assign(const Field& field, py::handle given) {
  py::object kept = field.keep ? field.keep(field.name, given, data()) : py::object();
  if (kept) {
    kept_[&field] = std::move(kept);
    return;
  }
  field.assign(field.name, given, data());
  kept_.erase(&field);
}

void Value::set(const Field& field, py::handle given) {
  if (is_frozen_)
    throw py::attribute_error("this " + class_->name +
                              " is a part of another value, where a change of it would be lost: assign a whole one, "
                              "such as what its replace() returns");
  const std::shared_ptr<Value> changed = copy();
  changed->assign(field, given);
  class_->check(changed->data());
  assign(field, given);
}

void Value::set_all(const py::args& args, const py::kwargs& kwargs) {
  if (args.size() > class_->positional)
    raise_type_error(class_->name + " takes at most " + std::to_string(class_->positional) +
                     " arguments by position, not " + std::to_string(args.size()) + ": give the others by name");
  for (size_t i = 0; i < args.size(); ++i) assign(class_->fields[i], args[i]);
  for (const auto& [key, given] : kwargs) {
    const Field& field = class_->field(py::str(key));
    for (size_t i = 0; i < args.size(); ++i)
      if (&field == &class_->fields[i]) raise_type_error(class_->name + " got '" + field.name + "' twice");
    assign(field, given);
  }
  class_->check(data());
}

void Value::lift(const std::shared_ptr<PythonScene>& scene) {
  for (const Field& field : class_->fields)
    if (field.lift)
      if (py::object part = field.lift(scene, data())) kept_[&field] = std::move(part);
}

std::shared_ptr<Value> Value::resolved(alhazen::Scene& scene) const {
  std::shared_ptr<Value> result = copy();
  for (const auto& [field, part] : kept_) field->resolve(field->name, part, scene, result->data());
  return result;
}

std::shared_ptr<Value> Value::frozen() const {
  if (is_frozen_) return std::const_pointer_cast<Value>(shared_from_this());
  std::shared_ptr<Value> result = copy();
  result->is_frozen_ = true;
  return result;
}

bool Value::equals(const Value& other) const {
  if (class_ != other.class_) return false;
  for (const Field& field : class_->fields)
    if (!same(get(field), other.get(field))) return false;
  return true;
}

std::string Value::repr() const {
  const std::shared_ptr<Value> new_value = class_->make();
  std::string text = "alhazen." + class_->name + "(";
  bool is_first = true;
  for (const Field& field : class_->fields) {
    const py::object value = get(field);
    if (same(value, new_value->get(field))) continue;
    text += (is_first ? "" : ", ") + field.name + "=" + shown_text(value);
    is_first = false;
  }
  return text + ")";
}

std::string signature(const ValueClass& of_class) {
  const std::shared_ptr<Value> new_value = of_class.make();
  std::string text = of_class.name + "(";
  for (size_t i = 0; i < of_class.fields.size(); ++i) {
    const Field& field = of_class.fields[i];
    if (i != 0) text += ", ";
    if (i == of_class.positional) text += "*, ";
    text += field.name + ": " + field.type + " = " + shown_text(new_value->get(field));
  }
  return text + ")";
}

void bind_properties(py::object python_class, const ValueClass& of_class) {
  const py::object property = py::module_::import("builtins").attr("property");
  for (const Field& field : of_class.fields) {
    const Field* f = &field;
    const py::cpp_function get([f](const Value& self) { return self.get(*f); }, py::is_method(python_class));
    const py::cpp_function set([f](Value& self, const py::object& given) { self.set(*f, given); },
                               py::is_method(python_class));
    python_class.attr(field.name.c_str()) = property(get, set, py::none(), field.type + ": " + field.doc);
  }
}

void bind_value_base(py::module_& m) {
  py::class_<Value, std::shared_ptr<Value>> value(
      m, "Value",
      "The base of everything that describes a part of a scene: materials, textures, lights, shapes, cameras.\n\n"
      "A value belongs to no scene. Adding it to one copies it, and so does assigning it to an attribute of another\n"
      "value: what is changed afterwards does not matter to them. Attributes are checked as soon as they are set, and\n"
      "InputError names what cannot be used. Names with 'color' may also be spelled 'colour'.");
  value.def("__repr__", &Value::repr)
      .def("__eq__",
           [](const Value& self, py::handle other) -> py::object {
             if (!py::isinstance<Value>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             return py::bool_(self.equals(other.cast<const Value&>()));
           })
      .def("__copy__", &Value::copy)
      .def("__deepcopy__", [](const Value& self, py::handle) { return self.copy(); })
      .def(
          "replace",
          [](const Value& self, const py::kwargs& changes) {
            std::shared_ptr<Value> result = self.copy();
            result->set_all(py::args(), changes);
            return result;
          },
          "Returns a copy with other values for some of the attributes, which are given by name.")
      .def("__getattr__",
           [](py::handle self, const std::string& name) -> py::object {
             // Called for names that are no attributes.
             if (const std::string spelled = american(name); spelled != name) return self.attr(spelled.c_str());
             throw py::attribute_error("'" + self.cast<const Value&>().value_class().name + "' has no attribute '" +
                                       name + "'");
           })
      .def("__setattr__", [](py::handle self, const std::string& name, py::handle given) {
        const py::object class_of = py::type::of(self);
        const std::string spelled = american(name);
        if (!py::hasattr(class_of, spelled.c_str()))
          throw py::attribute_error("'" + self.cast<const Value&>().value_class().name + "' has no attribute '" + name +
                                    "'");
        if (PyObject_GenericSetAttr(self.ptr(), py::str(spelled).ptr(), given.ptr()) != 0)
          throw py::error_already_set();
      });
  value.attr("__hash__") = py::none();
}

}  // namespace alhazen::python
