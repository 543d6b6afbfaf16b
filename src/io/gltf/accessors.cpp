#include "io/gltf/accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

/// Limit on elements that are not backed by bytes of the file (all are zero until sparse values replace some).
constexpr uint64_t max_zero_elements = uint64_t{1} << 24;

enum ComponentType : uint64_t { byte = 5120, ubyte, short_, ushort, uint = 5125, float_ };

struct Layout {
  size_t count = 0, rows = 1, columns = 1;
  uint64_t component_type = 0;
  size_t component_size = 0;
  bool normalized = false;
  size_t components() const { return rows * columns; }
  /// Columns of matrices are aligned to 4 bytes.
  size_t column_bytes() const {
    const size_t bytes = rows * component_size;
    return columns > 1 ? (bytes + 3) / 4 * 4 : bytes;
  }
  size_t element_bytes() const { return column_bytes() * columns; }
};

size_t size_of_component(const Document& document, const Json& object, uint64_t type) {
  switch (type) {
    case byte:
    case ubyte:
      return 1;
    case short_:
    case ushort:
      return 2;
    case uint:
    case float_:
      return 4;
    default:
      document.fail(object, "unknown \"componentType\" " + std::to_string(type) +
                                ": it may be 5120, 5121, 5122, 5123, 5125 or 5126");
  }
}

Layout read_layout(const Document& document, const Json& accessor) {
  Layout layout;
  layout.count = static_cast<size_t>(document.required_whole(accessor, "count"));
  if (layout.count == 0) document.fail(accessor, "the accessor is empty: \"count\" must be at least 1");
  layout.component_type = document.required_whole(accessor, "componentType");
  layout.component_size = size_of_component(document, accessor, layout.component_type);
  layout.normalized = document.flag(accessor, "normalized", false);
  const std::string type = document.string(accessor, "type");
  if (type.size() == 4 && (type.starts_with("VEC") || type.starts_with("MAT")) && type[3] >= '2' && type[3] <= '4') {
    layout.rows = static_cast<size_t>(type[3] - '0');
    if (type[0] == 'M') layout.columns = layout.rows;
  } else if (type != "SCALAR") {
    document.fail(accessor, "unknown \"type\" " + quoted(type) + " of an accessor");
  }
  return layout;
}

float component_value(const uint8_t* at, uint64_t type, bool normalized) {
  const auto load = [&]<class T>(T value, float largest) {
    std::memcpy(&value, at, sizeof(value));
    const float plain = static_cast<float>(value);
    return normalized ? std::max(plain / largest, -1.0f) : plain;
  };
  switch (type) {
    case byte:
      return load(int8_t{}, 127);
    case ubyte:
      return load(uint8_t{}, 255);
    case short_:
      return load(int16_t{}, 32767);
    case ushort:
      return load(uint16_t{}, 65535);
    case uint:
      return load(uint32_t{}, 4294967295.0f);
    default: {
      float value = 0;
      std::memcpy(&value, at, sizeof(value));
      return value;
    }
  }
}

uint32_t component_integer(const uint8_t* at, size_t size) {
  uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value |= uint32_t{at[i]} << (8 * i);
  return value;
}

/// Calls visit(element, component, bytes) for `count` elements that begin at `offset` of a view.
template <class Visit>
void for_each_component(const Document& document, const Json& place, const Layout& layout, size_t count,
                        const BufferView& view, uint64_t offset, bool is_strided, const Visit& visit) {
  const size_t element = layout.element_bytes(), stride = is_strided && view.stride != 0 ? view.stride : element;
  if (stride < element)
    document.fail(place, "elements of " + std::to_string(element) + " bytes overlap in a buffer view whose stride is " +
                             std::to_string(stride));
  const uint64_t available = view.bytes.size();
  // Written so that it cannot overflow, whatever the file contains.
  if (offset > available || element > available - offset || (count - 1) > (available - offset - element) / stride)
    document.fail(place, "the accessor's " + std::to_string(count) + " elements do not fit into its buffer view of " +
                             std::to_string(available) + " bytes");
  for (size_t i = 0; i < count; ++i) {
    const uint8_t* at = view.bytes.data() + offset + i * stride;
    for (size_t column = 0; column < layout.columns; ++column)
      for (size_t row = 0; row < layout.rows; ++row)
        visit(i, column * layout.rows + row, at + column * layout.column_bytes() + row * layout.component_size);
  }
}

struct SparseIndices {
  std::vector<uint32_t> indices;
  const Json* values = nullptr;
};

SparseIndices read_sparse(const Document& document, Buffers& buffers, const Json& sparse, size_t accessor_count) {
  const uint64_t count = document.required_whole(sparse, "count");
  const Json* indices = document.object(sparse, "indices");
  SparseIndices result;
  result.values = document.object(sparse, "values");
  if (indices == nullptr || result.values == nullptr)
    document.fail(sparse, "\"sparse\" needs \"indices\" and \"values\"");
  if (count == 0 || count > accessor_count)
    document.fail(sparse, "\"sparse\" must replace at least one element and at most all of them");
  Layout layout;
  layout.component_type = document.required_whole(*indices, "componentType");
  if (layout.component_type != ubyte && layout.component_type != ushort && layout.component_type != uint)
    document.fail(*indices, "sparse indices must be unsigned integers (5121, 5123 or 5125)");
  layout.component_size = size_of_component(document, *indices, layout.component_type);
  const BufferView& view = buffers.view(document.required_index(*indices, "bufferView", "bufferViews"));
  const uint64_t offset = document.whole(*indices, "byteOffset").value_or(0);
  for_each_component(document, *indices, layout, static_cast<size_t>(count), view, offset, false,
                     [&](size_t, size_t, const uint8_t* at) {
                       const uint32_t index = component_integer(at, layout.component_size);
                       if (index >= accessor_count)
                         document.fail(*indices, "sparse index " + std::to_string(index) +
                                                     " is out of range: there are " + std::to_string(accessor_count) +
                                                     " elements");
                       result.indices.push_back(index);
                     });
  return result;
}

/// Shared by both kinds of reading: `convert(bytes)` returns the value of a component.
template <class Value, class Convert>
std::vector<Value> read_all(const Document& document, Buffers& buffers, const Json& accessor, const Layout& layout,
                            const Convert& convert) {
  const std::optional<uint32_t> view = document.index(accessor, "bufferView", "bufferViews");
  const size_t components = layout.components();
  std::vector<Value> data;
  const auto allocate = [&] { data.resize(layout.count * components); };
  if (view) {
    const BufferView& bytes = buffers.view(*view);
    if (layout.count > bytes.bytes.size())
      document.fail(accessor, "the accessor's " + std::to_string(layout.count) +
                                  " elements do not fit into its buffer view of " + std::to_string(bytes.bytes.size()) +
                                  " bytes");
    allocate();
    for_each_component(document, accessor, layout, layout.count, bytes,
                       document.whole(accessor, "byteOffset").value_or(0), true,
                       [&](size_t i, size_t c, const uint8_t* at) { data[i * components + c] = convert(at); });
  } else {
    if (layout.count > max_zero_elements)
      document.fail(accessor, "the accessor has no buffer view and more than 2^24 elements");
    allocate();
  }
  if (const Json* sparse = document.object(accessor, "sparse")) {
    const SparseIndices replaced = read_sparse(document, buffers, *sparse, layout.count);
    const BufferView& values = buffers.view(document.required_index(*replaced.values, "bufferView", "bufferViews"));
    for_each_component(document, *replaced.values, layout, replaced.indices.size(), values,
                       document.whole(*replaced.values, "byteOffset").value_or(0), false,
                       [&](size_t i, size_t c, const uint8_t* at) {
                         data[size_t{replaced.indices[i]} * components + c] = convert(at);
                       });
  }
  return data;
}

}  // namespace

uint64_t element_bytes(const Document& document, const Json& accessor) {
  return read_layout(document, accessor).element_bytes();
}

uint64_t component_bytes(const Document& document, const Json& object, uint64_t component_type) {
  return size_of_component(document, object, component_type);
}

size_t Accessors::count(uint32_t index) const {
  return read_layout(document_, document_.item("accessors", index)).count;
}

bool Accessors::is_normalized(uint32_t index) const {
  return document_.flag(document_.item("accessors", index), "normalized", false);
}

Values Accessors::floats(uint32_t index, std::initializer_list<const char*> types) {
  const Json& accessor = document_.item("accessors", index);
  const Layout layout = read_layout(document_, accessor);
  const std::string type = document_.string(accessor, "type");
  if (std::find(types.begin(), types.end(), type) == types.end())
    document_.fail(accessor, "the accessor is used where one of type " + std::string(*types.begin()) +
                                 " is needed; it is of type " + type);
  Values values{layout.count, layout.components(), {}};
  values.data = read_all<float>(document_, buffers_, accessor, layout, [&](const uint8_t* at) {
    return component_value(at, layout.component_type, layout.normalized);
  });
  const auto odd = std::find_if(values.data.begin(), values.data.end(), [](float v) { return !std::isfinite(v); });
  if (odd != values.data.end())
    document_.fail(accessor, "element " +
                                 std::to_string(static_cast<size_t>(odd - values.data.begin()) / values.components) +
                                 " of the accessor is infinite or not a number");
  return values;
}

std::vector<uint32_t> Accessors::integers(uint32_t index, const char* type) {
  const Json& accessor = document_.item("accessors", index);
  const Layout layout = read_layout(document_, accessor);
  if (document_.string(accessor, "type") != type)
    document_.fail(accessor, std::string("the accessor is used where one of type ") + type + " is needed");
  if (layout.component_type != ubyte && layout.component_type != ushort && layout.component_type != uint)
    document_.fail(accessor, "the accessor is used where unsigned integers are needed (5121, 5123 or 5125)");
  return read_all<uint32_t>(document_, buffers_, accessor, layout,
                            [&](const uint8_t* at) { return component_integer(at, layout.component_size); });
}

}  // namespace alhazen::impl::gltf
