#pragma once

// JSON (RFC 8259) with the place of every value, so that errors can point at what is wrong.

#include <string>
#include <string_view>
#include <vector>

namespace alhazen::gltf {

enum class JsonKind { null, boolean, number, string, array, object };

struct Json {
  JsonKind kind = JsonKind::null;
  bool boolean = false;
  double number = 0;
  int line = 0, column = 0;  ///< from 1; of the first character
  std::string string;
  std::vector<Json> items;        ///< of arrays and objects
  std::vector<std::string> keys;  ///< objects: the names of `items`

  /// The member of this name, or null; null too where this is no object.
  const Json* find(std::string_view key) const;
};

/// An object without members, for what a file leaves out.
const Json& empty_object();

/// Throws InputError with the place in `file`. Nesting deeper than 128 is refused.
Json parse_json(std::string_view text, const std::string& file);

}  // namespace alhazen::gltf
