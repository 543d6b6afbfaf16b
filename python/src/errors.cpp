// The exceptions of the library as classes of Python.

#include "alhazen/error.h"

#include <cstring>
#include <string>
#include <utility>

#include "bindings.h"

namespace alhazen::python {

namespace {

/// Owned for as long as the process: exceptions may be raised while the interpreter shuts down.
PyObject *error_class = nullptr, *input_error_class = nullptr;

PyObject* new_class(py::module_& m, const char* name, const char* doc, const py::tuple& bases) {
  const std::string full_name = std::string("alhazen.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  m.attr(name) = py::reinterpret_borrow<py::object>(made);
  return made;
}

/// Sets an instance of the class with the message and `attributes`.
template <class... Attributes>
void raise(PyObject* of_class, const char* message, const Attributes&... attributes) {
  try {
    const py::object error = py::reinterpret_borrow<py::object>(of_class)(py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(message, static_cast<Py_ssize_t>(std::strlen(message)), "backslashreplace")));
    (py::setattr(error, attributes.first, attributes.second), ...);
    PyErr_SetObject(of_class, error.ptr());
  } catch (py::error_already_set& failure) {
    failure.restore();
  }
}

py::object place(int number) { return number > 0 ? py::object(py::int_(number)) : py::object(py::none()); }

py::object file_name(const std::string& file) {
  if (file.empty()) return py::none();
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeFSDefaultAndSize(file.data(), static_cast<Py_ssize_t>(file.size())));
}

/// Most derived classes first.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise(input_error_class, error.what(), std::pair("file", file_name(error.file())),
          std::pair("line", place(error.line())), std::pair("column", place(error.column())));
  } catch (const Error& error) {
    raise(error_class, error.what());
  }
}

}  // namespace

void bind_errors(py::module_& m) {
  error_class = new_class(m, "Error",
                          "A failure that Alhazen reports; the text is one complete message for a person.\n\n"
                          "It is a RuntimeError. InputError is its subclass for input that cannot be used.",
                          py::make_tuple(py::handle(PyExc_RuntimeError)));
  input_error_class = new_class(
      m, "InputError",
      "Input that cannot be used: a malformed or missing file, a setting or an argument out of range.\n\n"
      "It is an Error and a ValueError. The text begins with 'file:line:column: ' where there is a file, and\n"
      "names the argument where there is none.\n\n"
      "Attributes: file (str or None), line (int from 1, or None), column (int from 1, or None).",
      py::make_tuple(py::handle(error_class), py::handle(PyExc_ValueError)));
  for (const char* attribute : {"file", "line", "column"})
    py::setattr(py::handle(input_error_class), attribute, py::none());
  py::register_exception_translator(&translate);
}

}  // namespace alhazen::python
