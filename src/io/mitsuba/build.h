#pragma once

// The state of the reader while it turns the objects of a document into a scene. The kinds of objects are functions
// over it, with one file for each.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "io/mitsuba/object_reader.h"
#include "scene/scene.h"

namespace alhazen::impl::mitsuba {

/// A BSDF as read.
struct ReadBsdf {
  uint32_t material = no_index;  ///< no_index: its surfaces are invisible
  bool is_black_behind = false;  ///< Mitsuba shows the back of its surfaces black
};

struct Build {
  Build(Document document_, Diagnostics& diagnostics_) : document(std::move(document_)), diagnostics(diagnostics_) {}

  Document document;
  Diagnostics& diagnostics;
  Scene scene;

  std::map<uint32_t, ReadBsdf> bsdfs;                              ///< by object
  std::map<std::pair<uint32_t, bool>, uint32_t> textures;          ///< by object and whether it is a scalar
  std::map<uint32_t, uint32_t> groups;                             ///< by object, a shape group
  std::map<uint32_t, uint64_t> merged_shapes;                      ///< by object, a merge: how many shapes it makes
  std::map<std::tuple<std::string, bool, bool>, uint32_t> images;  ///< by file, whether it is raw and a scalar
  std::map<std::string, uint32_t> meshes;                          ///< by file and how it is read
  std::map<std::array<double, 3>, uint32_t> constants;
  uint32_t default_material = no_index;
  bool has_warned_of_backs = false;
  uint64_t shape_count = 0;  ///< of the scene and its groups, with those of merges

  void warn(const Place& place, const std::string& message) { diagnostics.warn(place.location(), message); }

  const Object& object(const Property& property) const { return document.objects[property.object]; }

  uint32_t add_texture(Texture texture) {
    scene.textures.push_back(std::move(texture));
    return static_cast<uint32_t>(scene.textures.size() - 1);
  }

  uint32_t constant_texture(const Vec3d& value) {
    const auto [entry, is_new] = constants.try_emplace({value.x, value.y, value.z}, 0u);
    if (is_new) {
      Texture texture;
      texture.value = value;
      entry->second = add_texture(texture);
    }
    return entry->second;
  }
};

}  // namespace alhazen::impl::mitsuba
