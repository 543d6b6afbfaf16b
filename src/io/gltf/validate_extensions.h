#pragma once

// References that extensions make.

#include "io/gltf/document.h"

namespace alhazen::impl::gltf {

/// Throws InputError if an extension that is read refers to something that does not exist, used or not.
void validate_extensions(const Document& document);

}  // namespace alhazen::impl::gltf
