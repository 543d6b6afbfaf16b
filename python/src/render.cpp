// What renders, and what it needs.

#include "alhazen/alhazen.h"

#include <optional>
#include <utility>

#include "alhazen/scene.h"
#include "bindings.h"
#include "convert.h"
#include "interruptible.h"
#include "progress.h"
#include "python_renderer.h"
#include "python_scene.h"
#include "python_warnings.h"
#include "rendered_image.h"
#include "renderer.h"
#include "settings.h"

namespace alhazen::python {

namespace {

RenderedImage render_file(const std::string& file, const alhazen::Settings& settings, const py::object& progress) {
  const auto is_dropped = std::make_shared<std::atomic<bool>>(false);
  const ProgressFunction function = progress_function(progress, is_dropped);
  std::optional<RenderedImage> image;
  run_interruptible([&] { image = alhazen::render(file, settings, function); }, [&] { *is_dropped = true; });
  return std::move(*image);
}

py::object render(const py::object& scene, const alhazen::Settings& settings, const py::object& progress) {
  if (is_file_name(scene)) {
    RenderedImage image = render_file(file_name("scene", scene), settings, progress);
    issue_warnings(image.warnings);
    return python_image(std::move(image));
  }
  if (!py::isinstance<PythonScene>(scene)) refuse_given("scene", "an alhazen.Scene or the name of a file", scene);
  PythonRenderer renderer(settings);
  return python_image(renderer.render(py::cast<const PythonScene&>(scene), progress, py::none(), py::none()));
}

/// Reads a scene by the settings that are about reading, and returns it with the others.
py::tuple load_by_settings(const py::object& file, alhazen::Settings settings) {
  LoadOptions options;
  options.camera = std::exchange(settings.camera, {});
  options.variant = std::exchange(settings.variant, {});
  options.animation = std::exchange(settings.animation, {});
  options.time = std::exchange(settings.animation_time, {});
  options.shutter = std::exchange(settings.shutter, {});
  options.frames_per_second = settings.frames_per_second;
  options.definitions = std::exchange(settings.definitions, {});
  options.search_paths = settings.search_paths;
  options.confine = settings.confine;
  options.strict = settings.strict;
  const std::string name = file_name("scene", file);
  std::shared_ptr<PythonScene> scene;
  run_droppable([&](const ProgressFunction& function) {
    scene = std::make_shared<PythonScene>(alhazen::Scene::load(name, options, function));
  });
  issue_warnings(scene->read().warnings());
  return py::make_tuple(scene, settings);
}

}  // namespace

void bind_render(py::module_& m) {
  bind_warnings(m);
  bind_interrupts(m);
  bind_settings(m);
  bind_progress(m);
  bind_rendered_image(m);
  bind_renderer(m);
  m.def("_render", &render, py::arg("scene"), py::arg("settings"), py::arg("progress"));
  m.def("_load_by_settings", &load_by_settings, py::arg("file"), py::arg("settings"));
  m.def(
      "_settings",
      [](const std::string& function, const py::object& base, const py::dict& keywords) {
        return settings_of(function, base, keywords);
      },
      py::arg("function"), py::arg("base"), py::arg("keywords"));
}

}  // namespace alhazen::python
