#pragma once

// Rays and hits in arrays of NumPy, which the library reads and writes in place.

#include <pybind11/numpy.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "alhazen/rays.h"
#include "bindings.h"

namespace alhazen::python {

/// Arguments of a query, as they are given.
struct RayArguments {
  py::object origins, directions, t_max, time;
};

/// Rays as arrays of one precision. They are views of what is given where its type and strides allow, and copies
/// otherwise.
template <class Real>
class RayInput {
 public:
  /// Checks shapes and values; throws InputError that names the argument.
  explicit RayInput(const RayArguments& arguments);

  RayArrays<Real> rays;
  /// Of the results: that of the origins without its last axis; empty for a single ray.
  std::vector<py::ssize_t> shape;

 private:
  struct Values {
    py::array_t<Real> array;
    std::vector<py::ssize_t> shape;  ///< without the axis of components
    std::ptrdiff_t stride = 0;       ///< elements from a ray to the next
  };
  Values vectors(const char* name, const py::object& given);
  Values numbers(const char* name, const py::object& given);
  void check_finite(const char* name, const Values& values, size_t components, bool may_be_infinite) const;
  void match_shape(const char* name, const Values& values) const;

  std::vector<py::object> kept_;
};

/// Whether rays are traced in double precision: by `precision` ("float" or "double") if it is given, otherwise if an
/// array has values that float does not hold, as those of float64 and of lists.
bool is_double(const RayArguments& arguments, const py::object& precision);

/// The arrays of the hits that were asked for, by their names.
class Hits {
 public:
  static const std::vector<std::string>& all_fields();
  /// `fields`: names, or None for all. t is always there. Throws InputError for another name.
  static std::vector<std::string> fields_of(const py::object& fields);

  /// Allocates arrays of `shape` without initializing them.
  template <class Real>
  static Hits allocate(const std::vector<py::ssize_t>& shape, const std::vector<std::string>& fields,
                       HitArrays<Real>& arrays);

  const std::map<std::string, py::object>& arrays() const { return arrays_; }
  /// Throws AttributeError for one that was not asked for.
  py::object field(const std::string& name) const;
  py::object hit() const;
  const std::vector<py::ssize_t>& shape() const { return shape_; }

 private:
  std::map<std::string, py::object> arrays_;
  std::vector<py::ssize_t> shape_;
  mutable py::object hit_;
};

}  // namespace alhazen::python
