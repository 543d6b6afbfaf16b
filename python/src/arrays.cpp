#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/error.h"
#include "convert.h"

namespace alhazen::python {

namespace {

constexpr py::ssize_t max_vertices = 0xfffffff0, max_faces = 0xffffffff / 3;

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

std::string dtype_of(const py::array& array) { return py::str(array.dtype()); }

/// Of any object; what it raises is told, unless there is no memory.
py::array any_array(const std::string& name, py::handle given) {
  try {
    return py::array(py::module_::import("numpy").attr("asarray")(given));
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_MemoryError) || !error.matches(PyExc_Exception)) throw;
    refuse_given(name, "an array", given);
  }
}

void check_shape(const std::string& name, const py::array& array, const std::vector<py::ssize_t>& columns,
                 const std::string& shape) {
  bool fits = array.ndim() == 2;
  if (fits) fits = std::find(columns.begin(), columns.end(), array.shape(1)) != columns.end();
  if (!fits) refuse(name, "must have shape " + shape + ", not " + shape_of(array));
}

/// Contiguous, aligned, in the byte order of this machine; the same array if it is that already.
template <class T>
py::array laid_out(const py::array& array) {
  constexpr int flags = py::array::c_style | py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
  // Casts that overflow are found afterwards: they are infinite.
  const py::object quiet = py::module_::import("numpy").attr("errstate")(py::arg("all") = "ignore");
  quiet.attr("__enter__")();
  py::array result = py::array_t<T, flags>::ensure(array);
  if (!result) {
    py::error_already_set error;
    quiet.attr("__exit__")(py::none(), py::none(), py::none());
    throw error;
  }
  quiet.attr("__exit__")(py::none(), py::none(), py::none());
  return result;
}

template <class T>
void check_finite(const std::string& name, const py::array& array) {
  const auto* values = static_cast<const T*>(array.data());
  const auto per_row = array.size() / std::max<py::ssize_t>(array.shape(0), 1);
  for (py::ssize_t i = 0; i < array.size(); ++i)
    if (!std::isfinite(values[i]))
      refuse(name, "holds a value that is infinite or not a number, in row " + std::to_string(i / per_row));
}

py::array real_values(const std::string& name, const py::array& array) {
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') refuse(name, "must hold real numbers, not " + dtype_of(array));
  const bool is_single = kind == 'f' && array.itemsize() <= static_cast<py::ssize_t>(sizeof(float));
  py::array values = is_single ? laid_out<float>(array) : laid_out<double>(array);
  is_single ? check_finite<float>(name, values) : check_finite<double>(name, values);
  return values;
}

}  // namespace

py::array real_rows(const std::string& name, py::handle given, const std::vector<py::ssize_t>& columns,
                    const std::string& shape, std::optional<py::ssize_t> rows) {
  const py::array array = any_array(name, given);
  check_shape(name, array, columns, shape);
  if (rows && array.shape(0) != *rows)
    refuse(name, "must have a row for each of the " + std::to_string(*rows) + " vertices, not " +
                     std::to_string(array.shape(0)));
  if (array.shape(0) == 0) refuse(name, "must not be empty");
  if (array.shape(0) > max_vertices) refuse(name, "must have fewer than 2^32 rows");
  return real_values(name, array);
}

py::array index_rows(const std::string& name, py::handle given, py::ssize_t vertices) {
  const py::array array = any_array(name, given);
  check_shape(name, array, {3}, "(m, 3)");
  if (array.shape(0) == 0) refuse(name, "must not be empty");
  if (array.shape(0) > max_faces) refuse(name, "must have fewer than 2^32 indices");
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u') refuse(name, "must hold integers, not " + dtype_of(array));
  const py::object low = py::int_(array.attr("min")()), high = py::int_(array.attr("max")());
  if (low < py::int_(0)) refuse(name, "holds " + std::string(py::str(low)) + ": indices count from 0");
  if (!(high < py::int_(vertices)))
    refuse(name,
           "holds " + std::string(py::str(high)) + ", but there are only " + std::to_string(vertices) + " vertices");
  return laid_out<uint32_t>(array);
}

py::array pixel_array(const std::string& name, py::handle given) {
  const py::array array = any_array(name, given);
  const py::ssize_t channels = array.ndim() == 3 ? array.shape(2) : 1;
  if ((array.ndim() != 2 && array.ndim() != 3) || (channels != 1 && channels != 3 && channels != 4))
    refuse(name, "must have shape (h, w), (h, w, 3) or (h, w, 4), not " + shape_of(array));
  if (array.size() == 0) refuse(name, "must not be empty");
  constexpr py::ssize_t max_side = std::numeric_limits<int>::max(), max_texels = 1 << 30;
  if (array.shape(0) > max_side || array.shape(1) > max_side || array.shape(0) > max_texels / array.shape(1))
    refuse(name, "must have at most 2^30 pixels, not shape " + shape_of(array));
  const char kind = array.dtype().kind();
  if (kind == 'u' && array.itemsize() == 1) return laid_out<uint8_t>(array);
  if (kind != 'f') refuse(name, "must be of uint8 or of floats, not " + dtype_of(array));
  py::array values = laid_out<float>(array);
  check_finite<float>(name, values);
  return values;
}

Reals reals_of(const py::array& rows) {
  const auto size = static_cast<size_t>(rows.size());
  if (rows.itemsize() == sizeof(float)) return std::span(static_cast<const float*>(rows.data()), size);
  return std::span(static_cast<const double*>(rows.data()), size);
}

std::span<const uint32_t> indices_of(const py::array& rows) {
  return {static_cast<const uint32_t*>(rows.data()), static_cast<size_t>(rows.size())};
}

Pixels pixels_of(const py::array& pixels) {
  const auto size = static_cast<size_t>(pixels.size());
  Pixels result{.width = static_cast<int>(pixels.shape(1)),
                .height = static_cast<int>(pixels.shape(0)),
                .channels = pixels.ndim() == 3 ? static_cast<int>(pixels.shape(2)) : 1};
  if (pixels.itemsize() == 1)
    result.bytes = {static_cast<const uint8_t*>(pixels.data()), size};
  else
    result.floats = {static_cast<const float*>(pixels.data()), size};
  return result;
}

template <class T>
py::object copied_rows(std::span<const T> values, py::ssize_t columns) {
  if (values.empty()) return py::none();
  const auto rows = static_cast<py::ssize_t>(values.size()) / columns;
  return read_only(py::array_t<T>({rows, columns}, values.data()));
}

template py::object copied_rows(std::span<const float>, py::ssize_t);
template py::object copied_rows(std::span<const double>, py::ssize_t);
template py::object copied_rows(std::span<const uint32_t>, py::ssize_t);

py::array copied_pixels(const Pixels& pixels) {
  std::vector<py::ssize_t> shape{pixels.height, pixels.width};
  if (pixels.channels > 1) shape.push_back(pixels.channels);
  if (!pixels.bytes.empty()) return read_only(py::array_t<uint8_t>(shape, pixels.bytes.data()));
  return read_only(py::array_t<float>(shape, pixels.floats.data()));
}

}  // namespace alhazen::python
