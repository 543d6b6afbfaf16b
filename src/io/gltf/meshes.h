#pragma once

// Primitives of a glTF mesh as triangle meshes: all modes that have area, morph targets, skins.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/accessors.h"
#include "io/gltf/materials.h"

namespace alhazen::impl::gltf {

/// Deformations of a mesh before it is placed.
struct Deformation {
  std::vector<double> weights;   ///< of the morph targets; missing ones are 0
  std::vector<Matrix4> joints;   ///< of the skin: world from mesh; empty without one
  std::optional<Matrix4> baked;  ///< transforms every vertex, if a node's transform is singular
};

class Meshes {
 public:
  Meshes(const Document& document, Buffers& buffers, Accessors& accessors, Scene& scene)
      : document_(document), buffers_(buffers), accessors_(accessors), scene_(scene) {}

  /// The index into Scene::meshes of a primitive, as its material needs it, or nothing if it has no area (points,
  /// lines). Equal data give the same mesh.
  std::optional<uint32_t> read(const Json& primitive, const MaterialUse& material, const Deformation& deformation);

 private:
  const Document& document_;
  Buffers& buffers_;
  Accessors& accessors_;
  Scene& scene_;
  std::map<std::string, uint32_t> by_key_;
};

bool has_vertex_colours(const Document& document, const Json& primitive);
/// The number of morph targets of a primitive.
size_t target_count(const Document& document, const Json& primitive);

}  // namespace alhazen::impl::gltf
