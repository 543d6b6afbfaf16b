// alhazen.compare and alhazen.devices.

#include <pybind11/stl.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "alhazen/compare.h"
#include "alhazen/devices.h"
#include "bindings.h"
#include "convert.h"
#include "interruptible.h"
#include "rendered_image.h"

namespace alhazen::python {

namespace {

CompareOptions compare_options(const py::object& layer, const py::object& region, const py::object& reduce) {
  CompareOptions options;
  if (!layer.is_none()) options.layer = text("layer", layer);
  if (!region.is_none()) {
    constexpr const char* wanted = "four whole numbers x0, y0, x1, y1";
    if (!is_sequence(region) || py::len(region) != 4) refuse_given("region", wanted, region);
    options.region.emplace();
    for (size_t i = 0; i < 4; ++i)
      (*options.region)[i] = integer("region", py::object(region[py::int_(i)]), -(int64_t{1} << 40), int64_t{1} << 40);
  }
  options.reduce = static_cast<int>(integer("reduce", reduce, 1, 1 << 20));
  return options;
}

std::shared_ptr<Comparison> compare_images(const py::object& a, const py::object& b, const py::object& layer,
                                           const py::object& region, const py::object& reduce) {
  const CompareOptions options = compare_options(layer, region, reduce);
  const auto image_a = image_argument("a", a), image_b = image_argument("b", b);
  const Unlocked unlocked;
  return std::make_shared<Comparison>(alhazen::compare(*image_a, *image_b, options));
}

void bind_comparison(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  py::class_<Comparison, std::shared_ptr<Comparison>>(
      m, "Comparison",
      "How much two images differ, over R, G and B of linear values unless said otherwise. Pixels that are not finite\n"
      "in one of them are excluded; without any other pixel the measures are NaN.")
      .def_readonly("mse", &Comparison::mse, "float: mean squared error.")
      .def_readonly("rmse", &Comparison::rmse, "float: its root.")
      .def_readonly("relmse", &Comparison::relmse, "float: mean of (a - b)^2 / (b^2 + 0.01), b the reference.")
      .def_readonly("relmse_trimmed", &Comparison::relmse_trimmed,
                    "float: relmse without the 0.1 % of pixels with the largest terms.")
      .def_readonly("psnr", &Comparison::psnr,
                    "float: dB, of the sRGB-encoded values in [0, 1]; infinite for equal images.")
      .def_readonly("ssim", &Comparison::ssim, "float: structural similarity of the encoded luminance; 1 if equal.")
      .def_readonly("flip", &Comparison::flip, "float: mean FLIP error at 67 pixels per degree; 0 for equal images.")
      .def_readonly("mean_a", &Comparison::mean_a, "float: mean luminance of a.")
      .def_readonly("mean_b", &Comparison::mean_b, "float: mean luminance of b.")
      .def_readonly("max_abs", &Comparison::max_abs, "float: largest absolute difference of a channel.")
      .def_readonly("nonfinite_a", &Comparison::nonfinite_a, "int: pixels of a with a NaN or infinite channel.")
      .def_readonly("nonfinite_b", &Comparison::nonfinite_b, "int: pixels of b with a NaN or infinite channel.")
      .def_readonly("nonfinite_in_one", &Comparison::nonfinite_in_one,
                    "int: of those, pixels that are finite in the other image.")
      .def_readonly("compared", &Comparison::compared, "int: pixels that are finite in both.")
      .def_property_readonly(
          "flip_map",
          [](const py::object& self) {
            const auto& c = py::cast<const Comparison&>(self);
            return read_only(py::array(py::dtype::of<float>(), {c.height, c.width}, c.flip_map.data(), self));
          },
          "array: (h, w) float32, FLIP error of each pixel, 0 to 1; a view without a copy.")
      .def_property_readonly(
          "heat_map", [](const Comparison& c) { return python_image(alhazen::heat_map(c)); },
          "RenderedImage: the errors as colors, from black over purple and orange to pale yellow, as\n"
          "`alhazen compare --heat-map` writes them.")
      .def("__repr__", [](const Comparison& c) {
        char text[160];
        std::snprintf(text, sizeof(text), "<alhazen.Comparison: FLIP %.4g, relMSE %.4g, PSNR %.4g dB, SSIM %.4g>",
                      c.flip, c.relmse, c.psnr, c.ssim);
        return std::string(text);
      });
  m.def("compare", &compare_images, py::arg("a"), py::arg("b"), py::kw_only(), py::arg("layer") = py::none(),
        py::arg("region") = py::none(), py::arg("reduce") = 1,
        "compare(a: RenderedImage | path | array, b: RenderedImage | path | array, *, layer: str | None = None, "
        "region: Sequence[int] | None = None, reduce: int = 1) -> Comparison\n\n"
        "Compares an image with a reference, as `alhazen compare` does.\n\n"
        "a, b: each an alhazen.RenderedImage, the name of a file, or an array of floats (linear values) of the shape "
        "(h, w),\n"
        "(h, w, 3) or (h, w, 4); b is the reference. layer: compares this layer of both. region: compares the pixels\n"
        "from (x0, y0) to before (x1, y1). reduce: compares means of so many by so many pixels.\n\n"
        "Returns an alhazen.Comparison. Raises InputError if their sizes differ.");
}

py::list list_of(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(path_text(text));
  return list;
}

std::string availability(const std::string& kind, const std::string& name, bool available, const std::string& details) {
  return "<alhazen." + kind + " " + name + (available ? ": " : ", not available: ") + details + ">";
}

void bind_device_classes(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  py::class_<BackendInfo>(m, "BackendInfo", "A backend: what renders.")
      .def_readonly("name", &BackendInfo::name, "str: a value of the setting `backend`.")
      .def_readonly("available", &BackendInfo::available, "bool: whether it is here.")
      .def_readonly("details", &BackendInfo::details, "str: what it runs on; or why it cannot, and what to do.")
      .def_property_readonly(
          "devices", [](const BackendInfo& b) { return list_of(b.devices); }, "list[str]: its GPUs, by number.")
      .def_property_readonly(
          "strategies", [](const BackendInfo& b) { return list_of(b.strategies); },
          "list[str]: values of the setting `strategy`.")
      .def_property_readonly(
          "module",
          [](const BackendInfo& b) { return b.module.empty() ? py::object(py::none()) : path_text(b.module); },
          "str | None: the file that it was loaded from; None: it is part of the library.")
      .def("__repr__",
           [](const BackendInfo& b) { return availability("BackendInfo", b.name, b.available, b.details); });
  py::class_<DenoiserInfo>(m, "DenoiserInfo", "A denoiser.")
      .def_readonly("name", &DenoiserInfo::name, "str: a value of the setting `denoiser`.")
      .def_readonly("available", &DenoiserInfo::available, "bool: whether it is here.")
      .def_readonly("details", &DenoiserInfo::details, "str: what it runs on; or why it cannot, and what to do.")
      .def("__repr__",
           [](const DenoiserInfo& d) { return availability("DenoiserInfo", d.name, d.available, d.details); });
}

void bind_devices(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  bind_device_classes(m);
  py::class_<Devices>(m, "Devices", "What this machine can render with.")
      .def_readonly("backends", &Devices::backends, "list[BackendInfo]: what may render.")
      .def_readonly("denoisers", &Devices::denoisers, "list[DenoiserInfo]: what may denoise.")
      .def_readonly("processor", &Devices::processor, "str: model of the CPU.")
      .def_readonly("processors", &Devices::processors, "int: hardware threads that this process may use.")
      .def_readonly("instruction_sets", &Devices::instruction_sets, "list[str]: that kernels on CPUs are built for.")
      .def_property_readonly(
          "gpus",
          [](const Devices& d) {
            py::list names;
            for (const BackendInfo& backend : d.backends)
              for (const std::string& device : backend.devices)
                if (!names.contains(device)) names.append(device);
            return names;
          },
          "list[str]: GPUs, each once.")
      .def("__repr__", [](const Devices& d) {
        std::string text = "<alhazen.Devices: " + d.processor;
        for (const BackendInfo& b : d.backends) text += (b.available ? ", " : ", no ") + b.name;
        for (const DenoiserInfo& n : d.denoisers)
          if (n.available) text += ", denoiser " + n.name;
        return text + ">";
      });
  m.def("devices", &alhazen::devices, py::call_guard<Unlocked>(),
        "devices() -> Devices\n\n"
        "Lists the backends, their GPUs, the CPU and the denoisers, as `alhazen devices` does.\n\n"
        "Returns an alhazen.Devices. It loads the modules of all backends, which may take a second where there are "
        "GPUs.");
}

}  // namespace

void bind_tools(py::module_& m) {
  bind_comparison(m);
  bind_devices(m);
}

}  // namespace alhazen::python
