#pragma once

// The node hierarchy, at rest or at a time of an animation.

#include <array>
#include <optional>
#include <vector>

#include "io/gltf/accessors.h"
#include "io/gltf/matrices.h"

namespace alhazen::impl::gltf {

struct NodePose {
  Vec3d translation, scale{1, 1, 1};
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
  std::optional<Matrix4> matrix;               ///< instead of the three
  std::vector<double> weights;                 ///< of morph targets; empty: those of the mesh
};

/// Throws, with the location of the node `at`, if a matrix has numbers that are not finite or too large for ray
/// tracing.
void check_transform(const Document& document, const Json& at, const Matrix4& matrix);

class Nodes {
 public:
  /// Reads all nodes and checks that they form trees.
  Nodes(const Document& document, Accessors& accessors);

  /// Sets nodes to their state in animation `animation` at `time` seconds; time is clamped to the animation. What moves
  /// in steps is set to its state at `step_time`.
  void animate(const Json& animation, double time, double step_time);
  void animate(const Json& animation, double time) { animate(animation, time, time); }
  /// To be called once after the poses are final.
  void place();

  size_t size() const { return poses_.size(); }
  const Matrix4& world(uint32_t node) const { return world_[node]; }
  const NodePose& pose(uint32_t node) const { return poses_[node]; }
  /// The nodes of the scene, each once, parents before their children.
  std::vector<uint32_t> of_scene() const { return collect(true); }
  /// Those of them that are visible: KHR_node_visibility hides a node and its descendants.
  std::vector<uint32_t> drawn() const { return collect(false); }
  /// World-from-mesh matrices of the joints of a skin.
  std::vector<Matrix4> joints(uint32_t skin);

 private:
  void check_trees();
  std::vector<uint32_t> roots_of_scene() const;
  std::vector<uint32_t> collect(bool hidden_too) const;
  bool is_hidden(uint32_t node) const;

  const Document& document_;
  Accessors& accessors_;
  std::vector<NodePose> poses_;
  std::vector<std::vector<uint32_t>> children_;
  std::vector<uint32_t> parents_;  ///< no_index for roots
  std::vector<Matrix4> world_;
};

}  // namespace alhazen::impl::gltf
