#include "image.h"

#include "arrays.h"
#include "convert.h"
#include "described.h"
#include "enums.h"
#include "parts.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

PythonImage new_image(const py::object& pixels, const py::object& encoding, const py::object& takes_alpha,
                      const py::object& scalar, const py::object& name) {
  PythonImage image;
  if (is_file_name(pixels))
    image.file = file_name("pixels", pixels);
  else
    image.pixels = pixel_array("pixels", pixels);
  if (!encoding.is_none()) image.encoding = enum_value<Encoding>("encoding", encoding);
  image.takes_alpha = flag("takes_alpha", takes_alpha);
  image.scalar = flag("scalar", scalar);
  image.name = text("name", name);
  if (image.pixels && image.scalar) refuse("scalar", "is for files: give the pixels of one channel");
  if (image.takes_alpha && (!image.pixels || image.pixels->ndim() != 3 || image.pixels->shape(2) != 4))
    refuse("takes_alpha", "needs pixels of the shape (h, w, 4)");
  return image;
}

std::string image_text(const PythonImage& image) {
  if (!image.pixels) return "<alhazen.Image " + std::string(py::str(py::repr(path_text(image.file)))) + ">";
  return "<alhazen.Image: " + short_repr(*image.pixels) + ">";
}

}  // namespace

Pixels PythonImage::view(const char* argument) const {
  if (!pixels) refuse(argument, "must be pixels, not a file");
  pixel_array(argument, *pixels);
  Pixels result = pixels_of(*pixels);
  result.encoding = encoding.value_or(Encoding::srgb);
  result.takes_alpha = takes_alpha;
  result.name = name;
  return result;
}

PythonImage image_of(const std::string& name, py::handle given) {
  if (py::isinstance<PythonImage>(given)) return given.cast<const PythonImage&>();
  PythonImage image;
  if (is_file_name(given))
    image.file = file_name(name, given);
  else
    image.pixels = pixel_array(name, given);
  return image;
}

ImageId add_image(const PythonImage& image, alhazen::Scene& scene) {
  if (image.pixels) return scene.add(image.view("pixels"));
  return image.scalar ? scene.load_scalar_image(image.file, image.encoding)
                      : scene.load_image(image.file, image.encoding);
}

ImageId FieldType<ImageId>::read(const std::string& name, py::handle given) {
  if (!given.is_none()) refuse_given(name, "an Image, an array or the name of a file", given);
  return {};
}

py::object FieldType<ImageId>::keep(const std::string& name, py::handle given) {
  if (given.is_none()) return {};
  if (py::isinstance<SceneImage>(given)) return py::reinterpret_borrow<py::object>(given);
  return py::cast(image_of(name, given));
}

ImageId FieldType<ImageId>::resolve(const std::string&, py::handle kept, alhazen::Scene& scene) {
  if (py::isinstance<SceneImage>(kept)) return kept.cast<const SceneImage&>().id;
  return add_image(kept.cast<const PythonImage&>(), scene);
}

py::object FieldType<ImageId>::lift(const std::shared_ptr<PythonScene>& scene, ImageId image) {
  return image ? py::object(py::cast(SceneImage(scene, image))) : py::object();
}

void bind_images(py::module_& m) {
  py::class_<PythonImage> bound(
      m, "Image",
      "An image for textures: pixels, or the name of a file (PNG, JPEG, TGA, BMP, QOI, WebP, HDR, PFM, EXR).\n\n"
      "Pixels are an array of the shape (h, w), (h, w, 1), (h, w, 3) or (h, w, 4), rows from the top down. uint8 is 0 "
      "to\n"
      "255 in sRGB unless the encoding is 'linear'; floats are linear. Contiguous uint8 and float32 are held without "
      "a\n"
      "copy until the image is added to a scene, which copies them; other floats are converted to float32. Of four\n"
      "channels a scene takes the colors, or with takes_alpha the fourth as a linear grey image.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def(py::init(&new_image), py::arg("pixels"), py::arg("encoding") = py::none(), py::arg("takes_alpha") = false,
           py::arg("scalar") = false, py::arg("name") = "",
           "__init__(self, pixels: array | str | os.PathLike, encoding: str | None = None, takes_alpha: bool = False, "
           "scalar: bool = False, name: str = '')\n\n"
           "encoding: 'srgb', 'linear' (for data such as normals and roughness), or None for that of the format: sRGB "
           "of\n"
           "8 and 16 bits, linear of floats. scalar: one channel of a file, alpha if there is one that is not 1\n"
           "everywhere, else the mean of the colors. InputError names the argument that does not fit.")
      .def_property_readonly(
          "pixels", [](const PythonImage& self) { return self.pixels ? py::object(*self.pixels) : py::none(); },
          "The array, or None if it is a file.")
      .def_property_readonly(
          "file", [](const PythonImage& self) { return self.pixels ? py::none() : py::object(path_text(self.file)); },
          "The name of the file, or None if it is an array.")
      .def_property_readonly(
          "encoding",
          [](const PythonImage& self) {
            return self.encoding ? py::object(enum_name(*self.encoding)) : py::object(py::none());
          },
          "'srgb', 'linear' or None.")
      .def_property_readonly(
          "name", [](const PythonImage& self) { return path_text(self.name); }, "str: by which scene.images finds it.")
      .def("__repr__", &image_text);
}

}  // namespace alhazen::python
