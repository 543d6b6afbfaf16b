#include "progress.h"

#include <cstdio>
#include <utility>

#include "convert.h"
#include "interruptible.h"

namespace alhazen::python {

std::shared_ptr<py::object> shared_object(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            const py::gil_scoped_acquire locked;
            delete held;
          }};
}

bool says_stop(const py::object& result) {
  py::detail::make_caster<bool> caster;
  return caster.load(result, false) && !result.is_none() && !py::detail::cast_op<bool>(caster);
}

ProgressFunction progress_function(const py::object& progress, std::shared_ptr<const std::atomic<bool>> is_dropped) {
  std::shared_ptr<py::object> called;
  if (PyBool_Check(progress.ptr())) {
    if (progress.ptr() == Py_True)
      called = shared_object(py::module_::import("alhazen.progress").attr("ProgressBar")());
  } else if (!progress.is_none()) {
    if (PyCallable_Check(progress.ptr()) == 0) refuse_given("progress", "a function, True, False or None", progress);
    called = shared_object(progress);
  }
  return [called = std::move(called), is_dropped = std::move(is_dropped)](const Progress& state) {
    if (is_dropped->load()) throw RenderDropped();
    if (!called) return true;
    const WithinCall within;
    const py::gil_scoped_acquire locked;
    return !says_stop((*called)(state));
  };
}

void run_droppable(const std::function<void(const ProgressFunction&)>& call) {
  const auto is_dropped = std::make_shared<std::atomic<bool>>(false);
  const ProgressFunction progress = progress_function(py::none(), is_dropped);
  run_interruptible([&] { call(progress); }, [&] { *is_dropped = true; });
}

void bind_progress(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  py::class_<Progress>(m, "Progress", "How far a render is: what functions given as `progress` get.")
      .def_property_readonly(
          "activity", [](const Progress& p) { return p.activity; },
          "str: 'rendering', or before it what is done to read and build the scene, when only `seconds` is known.")
      .def_readonly("fraction", &Progress::fraction, "float: of the samples, 0 to 1; it does not decrease.")
      .def_readonly("seconds", &Progress::seconds, "float: of rendering so far.")
      .def_readonly("samples_done", &Progress::samples_done, "int: of all pixels.")
      .def_readonly("samples_total", &Progress::samples_total, "int: of all pixels; with a noise target an estimate.")
      .def_readonly("samples_loaded", &Progress::samples_loaded,
                    "int: of `samples_done`, from the checkpoint that is continued.")
      .def_readonly("pixels", &Progress::pixels, "int: of the image.")
      .def_readonly("noise", &Progress::noise,
                    "float: with a noise target, its estimate when pixels were last decided on; 0: none yet.")
      .def("__repr__", [](const Progress& p) {
        char text[160];
        std::snprintf(text, sizeof(text), "<alhazen.Progress: %s, %.1f %% in %.1f s>", p.activity, 100 * p.fraction,
                      p.seconds);
        return std::string(text);
      });
}

}  // namespace alhazen::python
