// The class alhazen.RenderedImage.

#include <pybind11/stl.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "alhazen/read_image.h"
#include "alhazen/save.h"
#include "convert.h"
#include "enums.h"
#include "interruptible.h"
#include "python_warnings.h"
#include "rendered_image.h"

namespace alhazen::python {

template <>
inline constexpr std::array enum_names<ToneMapping>{"none", "reinhard", "filmic", "aces", "agx"};

namespace {

py::tuple tuple_of(const std::vector<std::string>& texts) {
  py::tuple tuple(texts.size());
  for (size_t i = 0; i < texts.size(); ++i) tuple[i] = texts[i];
  return tuple;
}

std::vector<std::string> layer_names(const PythonRenderedImage& image) {
  std::vector<std::string> names;
  for (const ImageLayer& layer : image.layers())
    if (!layer.name.empty()) names.push_back(layer.name);
  return names;
}

/// numpy.asarray and numpy.array of an image.
py::object as_array(const py::object& self, const py::object& dtype, const py::object& copy) {
  const py::array pixels = py::cast<const PythonRenderedImage&>(self).layer(self, "");
  const bool is_converted = !dtype.is_none() && !py::dtype::from_args(dtype).is(pixels.dtype()) &&
                            !py::dtype::from_args(dtype).equal(pixels.dtype());
  if (is_converted && !copy.is_none() && !py::cast<bool>(copy))
    throw py::value_error("an image as " + py::cast<std::string>(py::str(dtype)) +
                          " needs a copy, since its values are float32");
  if (is_converted) return pixels.attr("astype")(dtype);
  return !copy.is_none() && py::cast<bool>(copy) ? py::object(pixels.attr("copy")()) : py::object(pixels);
}

SaveOptions save_options(const py::object& exposure, const py::object& white_balance, const py::object& tone_map,
                         const py::object& png_depth, const py::object& jpeg_quality, const py::object& exr_type) {
  SaveOptions options;
  options.exposure = number("exposure", exposure);
  if (!white_balance.is_none()) options.white_temperature = number("white_balance", white_balance);
  if (!tone_map.is_none()) options.tone_mapping = enum_value<ToneMapping>("tone_map", tone_map);
  options.png_depth = static_cast<int>(integer("png_depth", png_depth, 0, 1000));
  options.jpeg_quality = static_cast<int>(integer("jpeg_quality", jpeg_quality, 0, 1000));
  const std::string type = text("exr_type", exr_type);
  if (type != "half" && type != "float") refuse_given("exr_type", "one of 'half' and 'float'", exr_type);
  options.single_precision = type == "float";
  return options;
}

/// PNG, JPEG, HDR and PFM have R, G and B: those of an image of one channel, such as one of an array (h, w), are this.
RenderedImage coloured(const RenderedImage& grey) {
  RenderedImage image = grey;
  image.channels = {"R", "G", "B"};
  image.planes.assign(3, grey.planes.front());
  return image;
}

bool is_grey(const RenderedImage& image) { return image.channels == std::vector<std::string>{"Y"}; }

void save_image(const PythonRenderedImage& image, const py::object& file, const SaveOptions& options, bool overwrite) {
  const std::string name = file_name("file", file);
  if (!overwrite && std::filesystem::exists(std::filesystem::symlink_status(name))) {
    errno = EEXIST;
    PyErr_SetFromErrnoWithFilenameObject(PyExc_FileExistsError, path_text(name).ptr());
    throw py::error_already_set();
  }
  const Unlocked unlocked;
  const bool is_exr = name.ends_with(".exr") || name.ends_with(".EXR");
  alhazen::save(is_grey(image.rendered()) && !is_exr ? coloured(image.rendered()) : image.rendered(), name, options);
}

py::bytes png_of(const PythonRenderedImage& image, const SaveOptions& options) {
  std::vector<uint8_t> bytes;
  {
    const Unlocked unlocked;
    bytes = alhazen::encode_png(is_grey(image.rendered()) ? coloured(image.rendered()) : image.rendered(), options);
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string text_of(const PythonRenderedImage& image) {
  const RenderedImage& rendered = image.rendered();
  std::string text =
      "<alhazen.RenderedImage " + std::to_string(rendered.width) + " x " + std::to_string(rendered.height);
  for (const ImageLayer& layer : image.layers())
    if (layer.name.empty())
      for (const std::string& channel : layer.channels) text += (channel == layer.channels[0] ? ", " : " ") + channel;
  std::string names;
  for (const std::string& name : layer_names(image)) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) text += ", layers " + names;
  if (!rendered.denoiser.empty()) text += ", denoised by " + rendered.denoiser;
  return text + (rendered.complete ? ">" : ", not complete>");
}

py::dict metadata_of(const RenderedImage& image) {
  py::dict metadata;
  for (const auto& [name, text] : image.metadata) metadata[path_text(name)] = path_text(text);
  return metadata;
}

/// What is stored in a pickle, but for the planes.
py::tuple state_of(const PythonRenderedImage& image) {
  const RenderedImage& r = image.rendered();
  py::list planes;
  for (const std::vector<float>& plane : r.planes)
    planes.append(py::bytes(reinterpret_cast<const char*>(plane.data()), plane.size() * sizeof(float)));
  const py::object noise = r.noise ? py::object(py::make_tuple(r.noise->noise, r.noise->below, r.noise->mean_samples))
                                   : py::object(py::none());
  const py::tuple place = py::make_tuple(r.x, r.y, r.full_width, r.full_height);
  return py::make_tuple(r.width, r.height, tuple_of(r.channels), planes, r.complete, noise, r.denoiser, r.quality,
                        tuple_of(warning_texts(r.warnings)), place, r.samples, r.seconds, metadata_of(r));
}

std::vector<std::string> texts_of(const py::handle& tuple) {
  std::vector<std::string> texts;
  for (const py::handle each : tuple) texts.push_back(py::cast<std::string>(each));
  return texts;
}

std::shared_ptr<PythonRenderedImage> image_of_state(const py::tuple& state) {
  RenderedImage r;
  r.width = py::cast<int>(state[0]);
  r.height = py::cast<int>(state[1]);
  r.channels = texts_of(py::object(state[2]));
  const auto pixels = static_cast<size_t>(std::max(r.width, 0)) * static_cast<size_t>(std::max(r.height, 0));
  for (const py::handle each : py::object(state[3])) {
    const std::string_view bytes = py::cast<std::string_view>(py::reinterpret_borrow<py::bytes>(each));
    if (bytes.size() != pixels * sizeof(float)) throw py::value_error("the pickle of an image is damaged");
    std::vector<float> plane(pixels);
    std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(plane.data()));
    r.planes.push_back(std::move(plane));
  }
  if (r.planes.size() != r.channels.size()) throw py::value_error("the pickle of an image is damaged");
  r.complete = py::cast<bool>(state[4]);
  if (const py::object noise = state[5]; !noise.is_none()) {
    const auto values = py::cast<py::tuple>(noise);
    r.noise = ReachedNoise{py::cast<double>(values[0]), py::cast<double>(values[1]), py::cast<double>(values[2])};
  }
  r.denoiser = py::cast<std::string>(state[6]);
  r.quality = py::cast<std::string>(state[7]);
  set_warnings(r.warnings, texts_of(py::object(state[8])));
  const py::tuple place = state[9];
  r.x = py::cast<int>(place[0]);
  r.y = py::cast<int>(place[1]);
  r.full_width = py::cast<int>(place[2]);
  r.full_height = py::cast<int>(place[3]);
  r.samples = py::cast<double>(state[10]);
  r.seconds = py::cast<double>(state[11]);
  for (const auto& [name, text] : py::cast<py::dict>(state[12]))
    r.metadata[py::cast<std::string>(name)] = py::cast<std::string>(text);
  return std::make_shared<PythonRenderedImage>(std::move(r));
}

void bind_reached_noise(py::module_& m) {
  py::class_<ReachedNoise>(m, "ReachedNoise", "What a render with a noise target reached.")
      .def_readonly("noise", &ReachedNoise::noise, "float: root mean square of the estimated errors of all pixels.")
      .def_readonly("below", &ReachedNoise::below, "float: fraction of the pixels below the target.")
      .def_readonly("mean_samples", &ReachedNoise::mean_samples, "float: samples per pixel.")
      .def("__repr__", [](const ReachedNoise& n) {
        char text[120];
        std::snprintf(text, sizeof(text), "<alhazen.ReachedNoise %.4g, %.1f %% of the pixels below, %.1f samples>",
                      n.noise, 100 * n.below, n.mean_samples);
        return std::string(text);
      });
}

}  // namespace

void bind_rendered_image(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  bind_reached_noise(m);
  py::class_<PythonRenderedImage, std::shared_ptr<PythonRenderedImage>> image(
      m, "RenderedImage",
      "An image that was rendered or read: linear values (radiance, linear sRGB), rows from the top down, which do "
      "not\n"
      "change.\n\n"
      "numpy.asarray(image) has the shape (height, width, 3), or 4 with the alpha of a transparent background, by "
      "which\n"
      "R, G and B are then premultiplied; numpy.array(image) is a copy that may be written to. Arrays are float32,\n"
      "and those that are not copies are read-only and keep the image alive.\n\n"
      "alhazen.RenderedImage(pixels) makes one of an array of floats with the shape (h, w), (h, w, 3) or (h, w, 4).");
  image
      .def(py::init([](const py::object& pixels) {
             return std::make_shared<PythonRenderedImage>(RenderedImage(*image_argument("pixels", pixels)));
           }),
           py::arg("pixels"), "__init__(self, pixels: array)")
      .def_property_readonly(
          "width", [](const PythonRenderedImage& i) { return i.rendered().width; }, "int: pixels.")
      .def_property_readonly(
          "height", [](const PythonRenderedImage& i) { return i.rendered().height; }, "int: pixels.")
      .def_property_readonly(
          "shape", [](const py::object& self) { return as_array(self, py::none(), py::none()).attr("shape"); },
          "tuple[int, ...]: of numpy.asarray(image).")
      .def_property_readonly(
          "channels", [](const PythonRenderedImage& i) { return tuple_of(i.rendered().channels); },
          "tuple[str, ...]: R, G, B, perhaps A, and those of the layers: albedo.R, depth.Z, ...")
      .def_property_readonly(
          "layers", [](const PythonRenderedImage& i) { return tuple_of(layer_names(i)); },
          "tuple[str, ...]: names of the layers beside the image itself: albedo, depth, ...")
      .def(
          "layer",
          [](const py::object& self, const std::string& name) {
            return py::cast<const PythonRenderedImage&>(self).layer(self, name);
          },
          py::arg("name"),
          "layer(self, name: str) -> array\n\n"
          "The array of a layer: (h, w, 3) of albedo or normals, (h, w) of a single channel such as depth, which is a\n"
          "view without a copy. Raises KeyError that lists the layers.")
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            const auto& i = py::cast<const PythonRenderedImage&>(self);
            return i.has_channel(name) ? i.channel(self, name) : i.layer(self, name);
          },
          "__getitem__(self, name: str) -> array\n\n"
          "The array (h, w) of a channel, a view without a copy, or that of a layer: image['R'], image['albedo'].")
      .def("__contains__", [](const PythonRenderedImage& i,
                              const std::string& name) { return i.has_channel(name) || i.has_layer(name); })
      // Else `in` and iteration would try numbers.
      .def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def_property_readonly(
          "complete", [](const PythonRenderedImage& i) { return i.rendered().complete; },
          "bool: False if stopped before all samples were taken or the noise target was reached.")
      .def_property_readonly(
          "noise", [](const PythonRenderedImage& i) { return i.rendered().noise; },
          "ReachedNoise | None: of a render with a noise target.")
      .def_property_readonly(
          "denoiser",
          [](const PythonRenderedImage& i) {
            return i.rendered().denoiser.empty() ? py::object(py::none()) : py::cast(i.rendered().denoiser);
          },
          "str | None: the denoiser of R, G and B; None: they are not denoised.")
      .def_property_readonly(
          "quality",
          [](const PythonRenderedImage& i) {
            return i.rendered().quality.empty() ? py::object(py::none()) : py::cast(i.rendered().quality);
          },
          "str | None: the quality that was rendered (draft, good or final), or None.")
      .def_property_readonly(
          "samples", [](const PythonRenderedImage& i) { return i.rendered().samples; },
          "float: per pixel, on average; 0 of an image that was not rendered.")
      .def_property_readonly(
          "seconds", [](const PythonRenderedImage& i) { return i.rendered().seconds; }, "float: of rendering.")
      .def_property_readonly(
          "metadata", [](const PythonRenderedImage& i) { return metadata_of(i.rendered()); },
          "dict[str, str]: what `save` writes into the headers of files: scene, samples, seed, settings, ...")
      .def_property_readonly(
          "warnings", [](const PythonRenderedImage& i) { return tuple_of(warning_texts(i.rendered().warnings)); },
          "tuple[str, ...]: of the scene reader and the renderer.")
      .def("__repr__", &text_of)
      .def(
          "_repr_png_",
          [](const PythonRenderedImage& i) -> py::object {
            if (i.rendered().width == 0 || (!i.has_channel("R") && !is_grey(i.rendered()))) return py::none();
            return png_of(i, {});
          },
          "_repr_png_(self) -> bytes | None\n\nHow notebooks show it.")
      .def(py::pickle(&state_of, &image_of_state));
  image.attr("__iter__") = py::none();
  image.def(
      "save",
      [](const PythonRenderedImage& i, const py::object& file, const py::object& exposure,
         const py::object& white_balance, const py::object& tone_map, const py::object& png_depth,
         const py::object& jpeg_quality, const py::object& exr_type, bool overwrite) {
        save_image(i, file, save_options(exposure, white_balance, tone_map, png_depth, jpeg_quality, exr_type),
                   overwrite);
      },
      py::arg("file"), py::kw_only(), py::arg("exposure") = 0.0, py::arg("white_balance") = py::none(),
      py::arg("tone_map") = py::none(), py::arg("png_depth") = 8, py::arg("jpeg_quality") = 95,
      py::arg("exr_type") = "half", py::arg("overwrite") = true,
      "save(self, file: path, *, exposure: float = 0, white_balance: float | None = None, tone_map: str | None = None, "
      "png_depth: int = 8, jpeg_quality: int = 95, exr_type: str = 'half', overwrite: bool = True) -> None\n\n"
      "Writes the image, completely or not at all; the extension of the name chooses the format: .exr (all channels),\n"
      ".png, .jpg (sRGB, clamped to [0, 1]), .hdr, .pfm (R, G and B).\n\n"
      "exposure: stops, for PNG and JPEG. white_balance: kelvin; light of this color becomes white. tone_map: none,\n"
      "reinhard, filmic, aces or agx. png_depth: 8 or 16 bits. jpeg_quality: 1 to 100. exr_type: half or float, of\n"
      "colors. overwrite: False raises FileExistsError for a file that exists.\n\n"
      "Raises InputError for an extension or option that there is none of, Error if the file cannot be written.");
  image.def(
      "png",
      [](const PythonRenderedImage& i, const py::object& exposure, const py::object& white_balance,
         const py::object& tone_map, const py::object& png_depth) {
        return png_of(i, save_options(exposure, white_balance, tone_map, png_depth, py::int_(95), py::str("half")));
      },
      py::kw_only(), py::arg("exposure") = 0.0, py::arg("white_balance") = py::none(), py::arg("tone_map") = py::none(),
      py::arg("png_depth") = 8,
      "png(self, *, exposure: float = 0, white_balance: float | None = None, tone_map: str | None = None, "
      "png_depth: int = 8) -> bytes\n\n"
      "The bytes of the file that `save` writes under a name that ends in .png, with the same options.");
  m.def(
      "read_image",
      [](const py::object& file) {
        const std::string name = file_name("file", file);
        RenderedImage read;
        {
          const Unlocked unlocked;
          read = alhazen::read_image(name);
        }
        return python_image(std::move(read));
      },
      py::arg("file"),
      "read_image(file: path) -> RenderedImage\n\n"
      "Reads an image as an alhazen.RenderedImage: EXR (all its channels, unchanged), PNG, JPEG, TGA, BMP, QOI, HDR, "
      "PFM or WebP\n"
      "(R, G and B; formats for displays are decoded to linear). Raises InputError.");
}

}  // namespace alhazen::python
