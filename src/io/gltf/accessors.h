#pragma once

// Reads accessors as arrays of numbers: every component type, normalized integers, strides, sparse values.

#include <initializer_list>
#include <vector>

#include "io/gltf/buffers.h"

namespace alhazen::impl::gltf {

/// `count` elements of `components` numbers each.
struct Values {
  size_t count = 0, components = 0;
  std::vector<float> data;
  const float* operator[](size_t i) const { return data.data() + i * components; }
};

class Accessors {
 public:
  Accessors(const Document& document, Buffers& buffers) : document_(document), buffers_(buffers) {}

  /// As floats, all of them finite. `types` are those accepted here, such as {"VEC3", "VEC4"}.
  Values floats(uint32_t index, std::initializer_list<const char*> types);
  /// As unsigned integers: indices, joints.
  std::vector<uint32_t> integers(uint32_t index, const char* type);
  /// The number of elements of the accessor.
  size_t count(uint32_t index) const;
  bool is_normalized(uint32_t index) const;

 private:
  const Document& document_;
  Buffers& buffers_;
};

/// Bytes of one element, whose type and component type must be known ones.
uint64_t element_bytes(const Document& document, const Json& accessor);
/// Bytes of a number of type `component_type` (5120, ...); `object` is where it is named.
uint64_t component_bytes(const Document& document, const Json& object, uint64_t component_type);

}  // namespace alhazen::impl::gltf
