// alhazen.Renderer.

#include "renderer.h"

#include <pybind11/stl.h>

#include <cstdio>
#include <utility>

#include "python_renderer.h"
#include "rendered_image.h"
#include "settings.h"

namespace alhazen::python {

void bind_renderer(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  py::class_<BuildReport>(m, "BuildReport", "What Renderer.start did.")
      .def_readonly("is_new", &BuildReport::is_new, "bool: False if the scene that was built before is used.")
      .def_readonly("seconds", &BuildReport::seconds, "float: that it took.")
      .def("__repr__", [](const BuildReport& report) {
        char text[80];
        std::snprintf(text, sizeof(text), "<alhazen.BuildReport: %s in %.3f s>", report.is_new ? "built" : "reused",
                      report.seconds);
        return std::string(text);
      });

  py::class_<PythonRenderer>(
      m, "Renderer",
      "Renders scenes again and again, pass by pass if the image is to be seen meanwhile, and builds anew only what "
      "has\n"
      "changed of them. Images have the same bits as those of alhazen.render.\n\n"
      "    renderer = alhazen.Renderer(spp=256)\n"
      "    renderer.start(scene)\n"
      "    while renderer.render_pass():\n"
      "        show(renderer.image())\n"
      "    image = renderer.finish()\n\n"
      "One thread at a time may use a renderer, but any may stop it; several renderers are independent. A scene may "
      "be\n"
      "changed once `start` has returned.\n\n"
      "Takes an alhazen.Settings, its fields as keyword arguments, or both. Settings about reading a file (camera,\n"
      "variant, animation, definitions, ...) are arguments of alhazen.load instead.")
      .def(py::init([](const py::object& settings, const py::kwargs& keywords) {
             return std::make_unique<PythonRenderer>(settings_of("Renderer", settings, keywords));
           }),
           py::arg("settings") = py::none(), "__init__(self, settings: Settings | None = None, **keywords)")
      .def_property(
          "settings", [](const PythonRenderer& renderer) { return renderer.settings(); }, &PythonRenderer::set_settings,
          "Settings: a copy; those that are set count for the next `start`.")
      .def("start", &PythonRenderer::start, py::arg("scene"), py::arg("progress") = py::none(),
           "start(self, scene: Scene, progress: function | bool | None = None) -> BuildReport\n\n"
           "Begins an image of a scene, and drops one that is under way.\n\n"
           "scene: alhazen.Scene. progress: a function that is called with an alhazen.Progress about ten times a "
           "second,\n"
           "from another thread, and stops the render by returning False; True for a progress bar.\n\n"
           "Returns an alhazen.BuildReport.")
      .def("render_pass", &PythonRenderer::render_pass, py::arg("samples") = 0,
           "render_pass(self, samples: int = 0) -> bool\n\n"
           "Takes some samples of every pixel: `samples` rounded up to a multiple of 4, at most 64 (on GPUs 1024), or "
           "as\n"
           "many as suit if it is 0. Returns whether more are to be taken: False at the end, once the time limit has\n"
           "passed or the noise target is reached, and after `stop`.\n\n"
           "Ctrl-C stops it and raises KeyboardInterrupt; `finish` then returns the image so far.")
      .def(
          "image", [](PythonRenderer& renderer) { return python_image(renderer.image()); },
          "image(self) -> RenderedImage\n\n"
          "The image so far as an alhazen.RenderedImage, with all its layers, not denoised: the mean of the samples of "
          "every\n"
          "pixel.")
      .def(
          "denoised_image", [](PythonRenderer& renderer) { return python_image(renderer.denoised_image()); },
          "denoised_image(self) -> RenderedImage\n\n"
          "The same with R, G and B denoised by the denoiser of the settings, which must name one. The image goes on "
          "with\n"
          "the bits that it would have without.")
      .def_property_readonly("progress", &PythonRenderer::progress, "Progress: of the image under way.")
      .def("stop", &PythonRenderer::stop,
           "stop(self) -> None\n\n"
           "Ends the pass under way within a few milliseconds. Any thread may call it at any time.")
      .def(
          "finish", [](PythonRenderer& renderer) { return python_image(renderer.finish()); },
          "finish(self) -> RenderedImage\n\n"
          "Ends an image, after any number of passes: saves its checkpoint, denoises it, and returns it as an\n"
          "alhazen.RenderedImage. Raises what `progress` has raised.")
      .def(
          "render",
          [](const py::object& self, const PythonScene& scene, const py::object& progress,
             const py::object& after_pass) {
            return python_image(py::cast<PythonRenderer&>(self).render(scene, progress, after_pass, self));
          },
          py::arg("scene"), py::arg("progress") = py::none(), py::arg("after_pass") = py::none(),
          "render(self, scene: Scene, progress: function | bool | None = None, after_pass: function | None = None) -> "
          "RenderedImage\n\n"
          "All of it: start, passes until there are no more, finish. Returns an alhazen.RenderedImage.\n\n"
          "after_pass: a function that is called with this renderer between passes, where `image` and `progress` may "
          "be\n"
          "used; returning False stops. What functions raise is raised here. Ctrl-C drops the image and raises\n"
          "KeyboardInterrupt.")
      .def_property_readonly("warnings", &PythonRenderer::warnings,
                             "list[str]: of the scene that was built last and of the image, each once.")
      .def("__repr__", [](const PythonRenderer& renderer) {
        return "<alhazen.Renderer with " + py::cast<std::string>(py::repr(py::cast(renderer.settings()))) + ">";
      });
}

}  // namespace alhazen::python
