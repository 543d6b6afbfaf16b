#pragma once

// What a URI of a glTF file stands for: bytes within the URI, or a file beside the document.

#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::gltf {

struct Resource {
  std::vector<uint8_t> bytes;
  std::string name;  ///< the file, or a few words, for messages
};

/// The bytes that `uri`, a string of the document, leads to. Throws InputError where there are none: other schemes than
/// `data`, paths that are not relative, files that are missing.
Resource load_uri(const Document& document, const Json& uri);

}  // namespace alhazen::gltf
