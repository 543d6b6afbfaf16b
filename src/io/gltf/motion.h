#pragma once

// Motion blur: where nodes are while the shutter is open.

#include <optional>

#include "io/gltf/nodes.h"
#include "scene/scene.h"

namespace alhazen::impl::gltf {

/// The nodes in the middle of the time that the shutter is open, and when it closes. Points of a shape move linearly in
/// between. What moves in steps stays where it is when the shutter opens.
class Motion {
 public:
  Motion(const Document& document, Accessors& accessors, const Json& animation, double opening, double seconds);

  const Nodes& closing() const { return closing_; }
  Nodes& closing() { return closing_; }

  /// The transform of a mesh at `node`, which is `opening` when the shutter opens, if it is `local` in the node's
  /// space. Warns, naming `where`, if the mesh does not move as nearly linearly as it is rendered, and returns one at
  /// rest if it would be flat in between.
  MovingTransform of_mesh(uint32_t node, const Matrix4& opening, const Matrix4& local, const Json& where) const;

  /// Warns if lights of `opening` move: they are rendered at rest.
  void warn_of_lights(const Nodes& opening) const;

 private:
  const Document& document_;
  Nodes middle_, closing_;
};

}  // namespace alhazen::impl::gltf
