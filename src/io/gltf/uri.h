#pragma once

// Resolves URIs of a glTF file: to bytes within the URI, or to a file beside the document.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::impl::gltf {

struct Resource {
  std::vector<uint8_t> bytes;
  std::string name;  ///< the file, or a description, for messages
};

/// The bytes that `uri`, a string of the document, refers to; nothing if no file has that name. Throws InputError for
/// schemes other than `data`, paths that are not relative, and files that cannot be read.
std::optional<Resource> find_uri(const Document& document, const Json& uri);

/// The same; also throws if no file has that name.
Resource load_uri(const Document& document, const Json& uri);

}  // namespace alhazen::impl::gltf
