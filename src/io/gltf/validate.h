#pragma once

#include "io/gltf/document.h"

namespace alhazen::gltf {

/// Checks what can be told without the data: that every reference in the document leads to something, whether it is
/// drawn or not, and that what belongs together is there. Throws InputError at the first fault.
void validate(const Document& document);

}  // namespace alhazen::gltf
