#pragma once

#include "io/gltf/document.h"

namespace alhazen::impl::gltf {

/// Checks everything that does not need the data: that every reference in the document is valid, whether used or not,
/// and that required members are present. Throws InputError at the first error.
void validate(const Document& document);

}  // namespace alhazen::impl::gltf
