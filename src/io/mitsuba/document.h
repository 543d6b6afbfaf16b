#pragma once

// A Mitsuba scene as objects with typed properties: parameters are replaced, included files are part of it, and
// references are resolved.

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "files/input_file.h"
#include "io/find_file.h"
#include "io/mitsuba/xml.h"
#include "scene/transform.h"

namespace alhazen::impl::mitsuba {

enum class ValueKind {
  number,
  integer,
  boolean,
  text,
  vector,  ///< a vector or a point
  rgb,
  spectrum,       ///< `text`: one number, or pairs of wavelength and value
  spectrum_file,  ///< `text`: the name of a file of such pairs
  transform,
  object  ///< nested, or by reference
};

struct Property {
  ValueKind kind = ValueKind::number;
  std::string name;  ///< may be empty for objects
  Place place;
  std::string text;
  double number = 0;  ///< numbers and integers
  bool boolean = false;
  Vec3d vector{};  ///< vectors and rgb
  Transform transform;
  uint32_t object = 0;    ///< index into Document::objects
  std::string reference;  ///< the identifier that a reference names
};

/// An element with a type: a shape, a BSDF, a texture, ...
struct Object {
  std::string tag;   ///< shape, bsdf, texture, ...
  std::string type;  ///< sphere, diffuse, bitmap, ...
  std::string id;
  Place place;
  std::vector<Property> properties;
  bool is_of_version_1 = false;
};

struct Document {
  std::vector<Object> objects;  ///< the first is the scene
  /// Folders in which files are looked up, in this order: those of <path>, then those of the scene and what it
  /// includes.
  std::vector<std::string> folders;
  InputScope scope;
  FileSearch search;  ///< where files are looked up that are in none of the folders

  /// The file `name`. Throws InputError, with the location `place`, if it cannot be read.
  InputPath existing_file(const Place& place, const std::string& name) const;
};

/// `definitions` are NAME=VALUE, which count before those of <default>. Throws InputError.
Document read_document(const InputPath& path, const std::vector<std::string>& definitions,
                       const FileSearch& search = {});

/// The same for a text in memory, whose files are looked up in `folder`.
Document parse_document(const std::string& text, const std::string& name, const std::string& folder,
                        const std::vector<std::string>& definitions, const FileSearch& search = {});

}  // namespace alhazen::impl::mitsuba
