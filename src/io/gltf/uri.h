#pragma once

// Resolves URIs of a glTF file: to bytes within the URI, or to a file beside the document.

#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::gltf {

struct Resource {
  std::vector<uint8_t> bytes;
  std::string name;  ///< the file, or a description, for messages
};

/// The bytes that `uri`, a string of the document, refers to. Throws InputError for schemes other than `data`, paths
/// that are not relative, and missing files.
Resource load_uri(const Document& document, const Json& uri);

}  // namespace alhazen::gltf
