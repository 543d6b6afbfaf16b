#pragma once

// alhazen.Image: pixels or the name of a file, not yet in a scene.

#include <pybind11/numpy.h>

#include <optional>
#include <string>

#include "alhazen/scene.h"
#include "bindings.h"

namespace alhazen::python {

struct PythonImage {
  std::optional<py::array> pixels;  ///< exactly one of these
  std::string file;
  std::optional<Encoding> encoding;
  bool takes_alpha = false, scalar = false;
  std::string name;

  /// A view of the pixels, checked once more. Throws InputError for a file.
  Pixels view(const char* argument) const;
};

/// An Image, the name of a file or an array, of what an argument of this name got.
PythonImage image_of(const std::string& name, py::handle given);
/// Reads or copies it.
ImageId add_image(const PythonImage& image, alhazen::Scene& scene);

}  // namespace alhazen::python
