#pragma once

// Arrays of NumPy as the library takes them. Each function names the argument in the InputError for what does not fit.
// Arrays that have the type and layout already are not copied.

#include <pybind11/numpy.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alhazen/arrays.h"
#include "bindings.h"

namespace alhazen::python {

/// Rows of `columns` (one of them) finite numbers, as contiguous float32 or float64. `rows`: how many there must be;
/// otherwise at least one. `shape` describes it: "(n, 3)".
py::array real_rows(const std::string& name, py::handle given, const std::vector<py::ssize_t>& columns,
                    const std::string& shape, std::optional<py::ssize_t> rows = {});

/// Rows of three indices under `vertices`, as contiguous uint32.
py::array index_rows(const std::string& name, py::handle given, py::ssize_t vertices);

/// (h, w), (h, w, 1), (h, w, 3) or (h, w, 4), as contiguous uint8 or float32.
py::array pixel_array(const std::string& name, py::handle given);

/// Views of what the functions above return, valid for as long as the array.
Reals reals_of(const py::array& rows);
std::span<const uint32_t> indices_of(const py::array& rows);
Pixels pixels_of(const py::array& pixels);

/// A read-only copy of values that the scene holds, in rows of `columns`; None if there are none.
template <class T>
py::object copied_rows(std::span<const T> values, py::ssize_t columns);

/// A read-only copy of an image: (h, w) or (h, w, channels).
py::array copied_pixels(const Pixels& pixels);

}  // namespace alhazen::python
