#pragma once

// Materials: glTF's metallic-roughness model and its extensions, as principled materials of the scene description.

#include <map>
#include <tuple>

#include "io/gltf/textures.h"

namespace alhazen::impl::gltf {

/// A material as used by a shape.
struct MaterialUse {
  uint32_t material = no_index;  ///< index into Scene::materials
  std::optional<Emission> emission;
  UvSets uv_sets{0, 1};
  /// The mesh's uv set, 0 or 1, whose tangents normal maps and anisotropy use; absent if they are not needed.
  std::optional<int> tangent_set;
};

class Materials {
 public:
  Materials(const Document& document, Textures& textures, Scene& scene)
      : document_(document), textures_(textures), scene_(scene) {}

  /// Material `index` of the document, or the default one. Vertex colours multiply the base colour.
  const MaterialUse& use(std::optional<uint32_t> index, bool has_vertex_colours);

 private:
  const Document& document_;
  Textures& textures_;
  Scene& scene_;
  std::map<std::tuple<std::optional<uint32_t>, bool>, MaterialUse> uses_;
};

}  // namespace alhazen::impl::gltf
