#include "python_warnings.h"

namespace alhazen::python {

namespace {

/// Owned for as long as the process.
PyObject* warning_class = nullptr;

/// How many frames of Python are between a function of the extension and the caller's: those of the package itself.
Py_ssize_t stack_level() {
  Py_ssize_t level = 1;
  py::object frame = py::module_::import("sys").attr("_getframe")();
  for (; !frame.is_none(); frame = frame.attr("f_back"), ++level) {
    const py::dict globals = frame.attr("f_globals");
    if (!globals.contains("__package__") || !py::object(globals["__package__"]).equal(py::str("alhazen"))) return level;
  }
  return 1;
}

}  // namespace

void issue_texts(const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  const Py_ssize_t level = stack_level();
  for (const std::string& text : texts)
    if (PyErr_WarnEx(warning_class, text.c_str(), level) != 0) throw py::error_already_set();
}

void issue_new_warnings(const std::vector<std::string>& texts, std::set<std::string>& issued) {
  std::vector<std::string> added;
  for (const std::string& text : texts)
    if (issued.insert(text).second) added.push_back(text);
  issue_texts(added);
}

void bind_warnings(py::module_& m) {
  warning_class = PyErr_NewExceptionWithDoc(
      "alhazen.AlhazenWarning",
      "What a scene reader or the renderer warns of: input that is used differently from what it says.\n\n"
      "It is a UserWarning, which the module warnings can silence, or turn into an error.",
      PyExc_UserWarning, nullptr);
  if (warning_class == nullptr) throw py::error_already_set();
  m.attr("AlhazenWarning") = py::reinterpret_borrow<py::object>(warning_class);
}

}  // namespace alhazen::python
