#pragma once

// KHR_animation_pointer: animations of any number in the file, which a JSON pointer (RFC 6901) names.

#include <string>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::gltf {

/// What an animation sets a value to.
struct PointedValue {
  std::string pointer;
  std::vector<double> numbers;    ///< one for a number or a truth value, else those of an array
  const Json* channel = nullptr;  ///< where it is said
};

/// What the channels of `animation` that point say at `time` seconds.
std::vector<PointedValue> pointed_values(const Document& document, const Json& animation, double time);

/// Writes such values into the document, so that everything is read from it as it is at that time. A pointer that leads
/// nowhere is a warning.
void write_pointed_values(Document& document, const std::vector<PointedValue>& values);

}  // namespace alhazen::gltf
