#pragma once

// KHR_animation_pointer: animates any number in the file, referred to by a JSON pointer (RFC 6901).

#include <string>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::impl::gltf {

/// A value that an animation sets.
struct PointedValue {
  std::string pointer;
  std::vector<double> numbers;    ///< one for a number or boolean, else those of an array
  const Json* channel = nullptr;  ///< for messages
};

/// The values of the pointer channels of `animation` at `time` seconds.
std::vector<PointedValue> pointed_values(const Document& document, const Json& animation, double time);

/// Writes such values into the document, so that everything is read as it is at that time. A pointer that refers to
/// nothing causes a warning.
void write_pointed_values(Document& document, const std::vector<PointedValue>& values);

}  // namespace alhazen::impl::gltf
