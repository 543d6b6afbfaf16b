#pragma once

// JSON (RFC 8259) with the location of every value, so that errors can refer to it.

#include <string>
#include <string_view>
#include <vector>

namespace alhazen::impl::gltf {

enum class JsonKind { null, boolean, number, string, array, object };

struct Json {
  JsonKind kind = JsonKind::null;
  bool boolean = false;
  double number = 0;
  int line = 0, column = 0;  ///< of the first character, from 1
  std::string string;
  std::vector<Json> items;        ///< of arrays and objects
  std::vector<std::string> keys;  ///< of objects: the names of `items`

  /// The member of this name, or null; also null if this is not an object.
  const Json* find(std::string_view key) const;
};

/// An object without members, for those absent in a file.
const Json& empty_object();

/// Throws InputError with the location in `file`. Nesting deeper than 128 levels is refused.
Json parse_json(std::string_view text, const std::string& file);

}  // namespace alhazen::impl::gltf
