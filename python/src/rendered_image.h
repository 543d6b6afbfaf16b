#pragma once

// alhazen.RenderedImage: what was rendered or read, as arrays of NumPy.

#include <pybind11/numpy.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "bindings.h"

namespace alhazen::python {

/// Channels that are one array: albedo.R, albedo.G and albedo.B.
struct ImageLayer {
  std::string name;                   ///< albedo; empty: R, G, B and perhaps A
  std::vector<size_t> planes;         ///< in the order R, G, B, A or X, Y, Z, W or U, V
  std::vector<std::string> channels;  ///< names of these planes
};

/// An image that does not change, so that arrays may be views of it.
class PythonRenderedImage {
 public:
  explicit PythonRenderedImage(RenderedImage&& image);

  const RenderedImage& rendered() const { return *image_; }
  std::shared_ptr<const RenderedImage> shared() const { return image_; }
  const std::vector<ImageLayer>& layers() const { return layers_; }

  /// Arrays are read-only and keep `self`, this object of Python, alive where they are views of it. A channel: (h, w).
  py::array channel(const py::object& self, const std::string& name) const;
  /// (h, w), or (h, w, channels) interleaved, which is made once. Throws KeyError that lists the layers.
  py::array layer(const py::object& self, const std::string& name) const;
  bool has_channel(const std::string& name) const { return image_->plane(name) != nullptr; }
  bool has_layer(const std::string& name) const;

 private:
  py::array plane(const py::object& self, size_t index) const;
  const ImageLayer& find(const std::string& name) const;

  std::shared_ptr<const RenderedImage> image_;
  std::vector<ImageLayer> layers_;
  mutable std::map<std::string, py::array> interleaved_;
};

py::object python_image(RenderedImage&& image);

/// An argument that is an alhazen.RenderedImage, the name of a file, or an array of linear values of the shape (h, w),
/// (h, w, 3) or (h, w, 4). Throws InputError that begins with `name`.
std::shared_ptr<const RenderedImage> image_argument(const char* name, const py::object& given);

void bind_rendered_image(py::module_& m);

}  // namespace alhazen::python
