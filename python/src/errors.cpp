// The exceptions of the library as classes of Python.

#include "alhazen/error.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "bindings.h"
#include "convert.h"
#include "value.h"

namespace alhazen::python {

namespace {

/// Owned for as long as the process: exceptions may be raised while the interpreter shuts down.
PyObject *error_class = nullptr, *input_error_class = nullptr, *missing_file_class = nullptr;
PyObject *unsupported_class = nullptr, *out_of_memory_class = nullptr, *device_class = nullptr,
         *cancelled_class = nullptr;

PyObject* new_class(py::module_& m, const char* name, const char* doc, const py::tuple& bases) {
  const std::string full_name = std::string("alhazen.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  m.attr(name) = py::reinterpret_borrow<py::object>(made);
  return made;
}

/// Sets an instance of the class with the message and `attributes`.
template <class... Attributes>
void raise(PyObject* of_class, const std::string& message, const Attributes&... attributes) {
  try {
    const py::object error = py::reinterpret_borrow<py::object>(of_class)(path_text(message));
    (py::setattr(error, attributes.first, attributes.second), ...);
    PyErr_SetObject(of_class, error.ptr());
  } catch (py::error_already_set& failure) {
    failure.restore();
  }
}

py::object place(int number) { return number > 0 ? py::object(py::int_(number)) : py::object(py::none()); }

/// What arguments are called in Python, where the library's names differ.
constexpr std::pair<const char*, const char*> renamed[] = {
    {"lens_radius", "aperture"}, {"focal_distance", "focus"}, {"positions", "vertices"}, {"indices", "faces"}};

/// The message of an argument, with the names of Python between its quotation marks.
std::string with_python_names(const std::string& message) {
  std::string result = message;
  for (const auto& [ours, pythons] : renamed) {
    const std::string quoted = "'" + std::string(ours) + "'";
    for (size_t at = 0; (at = result.find(quoted, at)) != std::string::npos;)
      result.replace(at + 1, quoted.size() - 2, pythons);
  }
  // The first quotation is the argument.
  const size_t end = result.starts_with('\'') ? result.find('\'', 1) : std::string::npos;
  if (end == std::string::npos) return result;
  return american(result.substr(0, end)) + result.substr(end);
}

/// Whether it is about a file that does not exist, rather than what else is wrong with a name.
bool is_missing(const InputError& error) {
  return !error.file().empty() && error.line() == 0 && std::string_view(error.what()).ends_with(std::strerror(ENOENT));
}

/// Most derived classes first.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    const bool has_file = !error.file().empty();
    const std::string message = has_file ? error.what() : with_python_names(error.what());
    const py::object file = has_file ? py::object(path_text(error.file())) : py::object(py::none());
    if (is_missing(error))
      raise(missing_file_class, message, std::pair("file", file), std::pair("filename", file),
            std::pair("errno", py::object(py::int_(ENOENT))));
    else
      raise(input_error_class, message, std::pair("file", file), std::pair("line", place(error.line())),
            std::pair("column", place(error.column())));
  } catch (const UnsupportedError& error) {
    raise(unsupported_class, error.what());
  } catch (const OutOfMemoryError& error) {
    raise(out_of_memory_class, error.what());
  } catch (const DeviceError& error) {
    raise(device_class, error.what());
  } catch (const Cancelled& error) {
    raise(cancelled_class, error.what());
  } catch (const Error& error) {
    raise(error_class, error.what());
  }
}

}  // namespace

void bind_errors(py::module_& m) {
  error_class =
      new_class(m, "Error",
                "A failure that Alhazen reports; the text is one complete message for a person.\n\n"
                "It is a RuntimeError. Its subclasses are InputError, UnsupportedError, OutOfMemoryError, DeviceError\n"
                "and Cancelled.",
                py::make_tuple(py::handle(PyExc_RuntimeError)));
  input_error_class = new_class(
      m, "InputError",
      "Input that cannot be used: a malformed or missing file, a setting or an argument out of range.\n\n"
      "It is an Error and a ValueError. The text begins with 'file:line:column: ' where there is a file, and\n"
      "names the argument where there is none.\n\n"
      "Attributes: file (str or None), line (int from 1, or None), column (int from 1, or None).",
      py::make_tuple(py::handle(error_class), py::handle(PyExc_ValueError)));
  missing_file_class = new_class(m, "MissingFileError",
                                 "An InputError for a file that does not exist, which is a FileNotFoundError, too.\n\n"
                                 "Attributes: file, filename (str), errno.",
                                 py::make_tuple(py::handle(input_error_class), py::handle(PyExc_FileNotFoundError)));
  const py::tuple plain = py::make_tuple(py::handle(error_class));
  unsupported_class = new_class(m, "UnsupportedError",
                                "A setting asks for what this build or this machine does not have, such as a GPU or a\n"
                                "denoiser's library. Other settings may work.",
                                plain);
  out_of_memory_class =
      new_class(m, "OutOfMemoryError",
                "The memory of this machine or of its GPU, or a limit set on it, does not suffice.\n\n"
                "It is an Error and a MemoryError.",
                py::make_tuple(py::handle(error_class), py::handle(PyExc_MemoryError)));
  device_class = new_class(m, "DeviceError",
                           "A GPU, or a library that drives it, has failed while it worked. The process may not be\n"
                           "able to use it any more.",
                           plain);
  cancelled_class = new_class(m, "Cancelled",
                              "A progress function has returned False before there was an image: while a scene was\n"
                              "read or built. Renders do not raise it, but return the image so far.",
                              plain);
  // That of OSError makes a text of its own of errno and filename.
  py::setattr(py::handle(missing_file_class), "__str__", py::handle(PyExc_Exception).attr("__str__"));
  for (const char* attribute : {"file", "line", "column"})
    py::setattr(py::handle(input_error_class), attribute, py::none());
  py::register_exception_translator(&translate);
}

}  // namespace alhazen::python
