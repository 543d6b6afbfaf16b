#include "ray_arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "convert.h"

namespace alhazen::python {

namespace {

using Shape = std::vector<py::ssize_t>;

Shape shape_of(const py::array& array, py::ssize_t without_last) {
  return Shape(array.shape(), array.shape() + array.ndim() - without_last);
}

std::string text_of(const Shape& shape) {
  py::tuple tuple(shape.size());
  for (size_t i = 0; i < shape.size(); ++i) tuple[i] = shape[i];
  return py::cast<std::string>(py::str(tuple));
}

size_t count_of(const Shape& shape) {
  size_t count = 1;
  for (const py::ssize_t side : shape) count *= static_cast<size_t>(side);
  return count;
}

py::array real_array(const char* name, const py::object& given) {
  const py::array array = py::array::ensure(given);
  if (!array || std::string("fiu").find(array.dtype().kind()) == std::string::npos)
    refuse_given(name, "an array of numbers", given);
  return array;
}

/// The array in this precision; itself where it has it already.
template <class Real>
py::array_t<Real> converted(const char* name, const py::object& given) {
  auto array = py::array_t<Real, py::array::forcecast>::ensure(real_array(name, given));
  if (!array) throw py::error_already_set();
  return array;
}

/// Whether a sum of `count` products with 0 is 0: neither a NaN nor an infinity is among them.
template <class Real>
bool are_finite(const Real* values, size_t count) {
  Real sum = 0;
  for (size_t i = 0; i < count; ++i) sum += values[i] * Real(0);
  return sum == 0;
}

}  // namespace

template <class Real>
typename RayInput<Real>::Values RayInput<Real>::vectors(const char* name, const py::object& given) {
  Values values{converted<Real>(name, given), {}, 0};
  if (values.array.ndim() < 1 || values.array.shape(values.array.ndim() - 1) != 3)
    refuse(name, "must have the shape (n, 3), (..., 3) or (3,), not " + text_of(shape_of(values.array, 0)));
  values.shape = shape_of(values.array, 1);
  constexpr auto size = static_cast<py::ssize_t>(sizeof(Real));
  const bool is_view =
      values.array.ndim() == 2 && values.array.strides(1) == size && values.array.strides(0) % size == 0;
  if (is_view) {
    values.stride = values.array.strides(0) / size;
  } else {
    values.array = py::array_t<Real, py::array::c_style | py::array::forcecast>::ensure(values.array);
    if (!values.array) throw py::error_already_set();
    values.stride = values.shape.empty() ? 0 : 3;
  }
  check_finite(name, values, 3, false);
  kept_.push_back(values.array);
  return values;
}

template <class Real>
typename RayInput<Real>::Values RayInput<Real>::numbers(const char* name, const py::object& given) {
  Values values{converted<Real>(name, given), {}, 0};
  values.shape = shape_of(values.array, 0);
  constexpr auto size = static_cast<py::ssize_t>(sizeof(Real));
  if (values.array.ndim() == 1 && values.array.strides(0) % size == 0) {
    values.stride = values.array.strides(0) / size;
  } else {
    values.array = py::array_t<Real, py::array::c_style | py::array::forcecast>::ensure(values.array);
    if (!values.array) throw py::error_already_set();
    values.stride = values.shape.empty() ? 0 : 1;
  }
  check_finite(name, values, 1, true);
  match_shape(name, values);
  kept_.push_back(values.array);
  return values;
}

template <class Real>
void RayInput<Real>::check_finite(const char* name, const Values& values, size_t components,
                                  bool may_be_infinite) const {
  const Real* const data = values.array.data();
  const size_t count = count_of(values.shape);
  const bool is_dense = values.stride == static_cast<std::ptrdiff_t>(components);
  if (is_dense && are_finite(data, count * components)) return;
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < components; ++c) {
      const Real value = data[static_cast<std::ptrdiff_t>(i) * values.stride + static_cast<std::ptrdiff_t>(c)];
      if (std::isnan(value) || (!may_be_infinite && std::isinf(value)))
        refuse(name, std::string(std::isnan(value) ? "has a NaN" : "has an infinity") + " at ray " + std::to_string(i));
    }
}

template <class Real>
void RayInput<Real>::match_shape(const char* name, const Values& values) const {
  if (!values.shape.empty() && values.shape != shape)
    refuse(name, "must be a number or have the shape " + text_of(shape) + " of the rays, not " + text_of(values.shape));
}

template <class Real>
RayInput<Real>::RayInput(const RayArguments& arguments) {
  const Values origins = vectors("origins", arguments.origins),
               directions = vectors("directions", arguments.directions);
  shape = origins.shape.empty() ? directions.shape : origins.shape;
  if (!directions.shape.empty() && directions.shape != shape)
    refuse("directions", "must have the shape of 'origins', " + text_of(shape_of(origins.array, 0)) +
                             ", or (3,), not " + text_of(shape_of(directions.array, 0)));
  rays.count = count_of(shape);
  rays.origins = origins.array.data();
  rays.origin_stride = origins.shape.empty() ? 0 : origins.stride;
  rays.directions = directions.array.data();
  rays.direction_stride = directions.shape.empty() ? 0 : directions.stride;
  if (!arguments.t_max.is_none()) {
    const Values t_max = numbers("t_max", arguments.t_max);
    rays.t_max = t_max.array.data();
    rays.t_max_stride = t_max.stride;
  }
  if (!arguments.time.is_none()) {
    const Values times = numbers("time", arguments.time);
    rays.times = times.array.data();
    rays.time_stride = times.stride;
  }
}

template class RayInput<float>;
template class RayInput<double>;

bool is_double(const RayArguments& arguments, const py::object& precision) {
  if (!precision.is_none()) {
    const std::string name = text("precision", precision);
    if (name != "float" && name != "double") refuse_given("precision", "one of 'float' and 'double'", precision);
    return name == "double";
  }
  const auto is_wide = [](const char* name, const py::object& given) {
    const py::array array = real_array(name, given);
    return array.dtype().kind() != 'f' || array.itemsize() > static_cast<py::ssize_t>(sizeof(float));
  };
  return is_wide("origins", arguments.origins) || is_wide("directions", arguments.directions);
}

const std::vector<std::string>& Hits::all_fields() {
  static const std::vector<std::string> fields{"t",  "position",    "normal",    "shading_normal", "offset",
                                               "uv", "barycentric", "primitive", "shape",          "instance"};
  return fields;
}

std::vector<std::string> Hits::fields_of(const py::object& fields) {
  if (fields.is_none()) return all_fields();
  std::vector<std::string> asked{"t"};
  if (!is_sequence(fields)) refuse_given("fields", "a sequence of names such as ('t', 'normal')", fields);
  for (const py::handle each : py::reinterpret_borrow<py::sequence>(fields)) {
    const std::string name = text("fields", each);
    if (std::find(all_fields().begin(), all_fields().end(), name) == all_fields().end()) {
      std::string list;
      for (const std::string& field : all_fields()) list += (list.empty() ? "" : ", ") + field;
      refuse_given("fields", "some of " + list, each);
    }
    if (std::find(asked.begin(), asked.end(), name) == asked.end()) asked.push_back(name);
  }
  return asked;
}

template <class Real>
Hits Hits::allocate(const std::vector<py::ssize_t>& shape, const std::vector<std::string>& fields,
                    HitArrays<Real>& arrays) {
  Hits hits;
  hits.shape_ = shape;
  const auto add = [&](const char* name, auto& pointer, py::ssize_t components) {
    using Value = std::remove_reference_t<decltype(*pointer)>;
    if (std::find(fields.begin(), fields.end(), name) == fields.end()) return;
    std::vector<py::ssize_t> sides = shape;
    if (components > 1) sides.push_back(components);
    py::array_t<Value> array(sides);
    pointer = array.mutable_data();
    hits.arrays_[name] = std::move(array);
  };
  add("t", arrays.t, 1);
  add("position", arrays.positions, 3);
  add("normal", arrays.normals, 3);
  add("shading_normal", arrays.shading_normals, 3);
  add("offset", arrays.offsets, 1);
  add("uv", arrays.uvs, 2);
  add("barycentric", arrays.barycentrics, 2);
  add("primitive", arrays.primitives, 1);
  add("shape", arrays.shapes, 1);
  add("instance", arrays.instances, 1);
  return hits;
}

template Hits Hits::allocate(const Shape&, const std::vector<std::string>&, HitArrays<float>&);
template Hits Hits::allocate(const Shape&, const std::vector<std::string>&, HitArrays<double>&);

py::object Hits::field(const std::string& name) const {
  const auto found = arrays_.find(name);
  if (found != arrays_.end()) return found->second;
  throw py::attribute_error("'" + name + "' was not asked for: name it in the argument 'fields'");
}

py::object Hits::hit() const {
  if (!hit_) hit_ = py::module_::import("numpy").attr("isfinite")(arrays_.at("t"));
  return hit_;
}

}  // namespace alhazen::python
