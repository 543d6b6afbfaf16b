#include "io/gltf/nodes.h"

#include "scene/scene.h"

namespace alhazen::impl::gltf {

namespace {

NodePose read_pose(const Document& document, const Json& node) {
  NodePose pose;
  if (const std::vector<double> m = document.numbers(node, "matrix", 16); !m.empty()) {
    Matrix4 matrix;  // column by column in the file
    for (size_t i = 0; i < 16; ++i) matrix[i % 4][i / 4] = m[i];
    if (matrix[3] != identity[3]) document.fail(node, "the last row of \"matrix\" must be 0 0 0 1");
    pose.matrix = matrix;
  }
  pose.translation = document.vec3(node, "translation", pose.translation);
  pose.scale = document.vec3(node, "scale", pose.scale);
  if (const std::vector<double> q = document.numbers(node, "rotation", 4); !q.empty())
    pose.rotation = {q[0], q[1], q[2], q[3]};
  if (const Json* weights = document.list(node, "weights"))
    pose.weights = document.numbers(node, "weights", weights->items.size());
  return pose;
}

}  // namespace

void check_transform(const Document& document, const Json& at, const Matrix4& matrix) {
  // Lengths are squared and multiplied in single precision, whose largest number is 3.4e38.
  constexpr double largest = 1e18;
  for (const auto& row : matrix)
    for (const double value : row)
      if (!(std::abs(value) <= largest))
        document.fail(at,
                      "the transform of the node, with its ancestors, has numbers over 1e18, which are too large "
                      "for ray tracing: scale the scene down");
}

Nodes::Nodes(const Document& document, Accessors& accessors) : document_(document), accessors_(accessors) {
  const size_t count = document.array("nodes").size();
  children_.resize(count);
  parents_.assign(count, no_index);
  for (uint32_t i = 0; i < count; ++i) {
    const Json& node = document.item("nodes", i);
    poses_.push_back(read_pose(document, node));
    const Json* children = document.list(node, "children");
    if (children == nullptr) continue;
    for (const Json& value : children->items) {
      const uint32_t child = document.as_index(value, "nodes");
      if (parents_[child] != no_index)
        document.fail(value,
                      "node " + std::to_string(child) + " is the child of two nodes; it may have one parent only");
      parents_[child] = i;
      children_[i].push_back(child);
    }
  }
  check_trees();
}

/// As each node has one parent, nodes that no root reaches form a cycle.
void Nodes::check_trees() {
  std::vector<uint32_t> stack;
  std::vector<bool> reached(poses_.size());
  for (uint32_t i = 0; i < poses_.size(); ++i)
    if (parents_[i] == no_index) stack.push_back(i);
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    reached[node] = true;
    stack.insert(stack.end(), children_[node].begin(), children_[node].end());
  }
  for (uint32_t i = 0; i < poses_.size(); ++i)
    if (!reached[i]) document_.fail(document_.item("nodes", i), "node " + std::to_string(i) + " is its own ancestor");
}

void Nodes::place() {
  world_.assign(poses_.size(), identity);
  std::vector<uint32_t> stack;
  for (uint32_t i = 0; i < poses_.size(); ++i)
    if (parents_[i] == no_index) stack.push_back(i);
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    const NodePose& pose = poses_[node];
    const Matrix4 local = pose.matrix ? *pose.matrix : from_trs(pose.translation, pose.rotation, pose.scale);
    world_[node] = parents_[node] == no_index ? local : multiply(world_[parents_[node]], local);
    check_transform(document_, document_.item("nodes", node), world_[node]);
    stack.insert(stack.end(), children_[node].begin(), children_[node].end());
  }
}

std::vector<uint32_t> Nodes::roots_of_scene() const {
  std::vector<uint32_t> roots;
  const std::vector<Json>& scenes = document_.array("scenes");
  if (scenes.empty()) {
    for (uint32_t i = 0; i < poses_.size(); ++i)
      if (parents_[i] == no_index) roots.push_back(i);
    return roots;
  }
  const Json& scene = document_.item("scenes", document_.index(document_.root(), "scene", "scenes").value_or(0));
  if (const Json* nodes = document_.list(scene, "nodes"))
    for (const Json& value : nodes->items) roots.push_back(document_.as_index(value, "nodes"));
  return roots;
}

bool Nodes::is_hidden(uint32_t node) const {
  const Json* visibility = document_.extension(document_.item("nodes", node), "KHR_node_visibility");
  return visibility != nullptr && !document_.flag(*visibility, "visible", true);
}

std::vector<uint32_t> Nodes::collect(bool hidden_too) const {
  std::vector<uint32_t> order, stack = roots_of_scene();
  std::vector<bool> reached(poses_.size());
  std::vector<uint32_t> reversed(stack.rbegin(), stack.rend());
  stack = std::move(reversed);
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    if (reached[node]) continue;
    reached[node] = true;
    if (!hidden_too && is_hidden(node)) continue;
    order.push_back(node);
    stack.insert(stack.end(), children_[node].rbegin(), children_[node].rend());
  }
  return order;
}

std::vector<Matrix4> Nodes::joints(uint32_t skin) {
  const Json& description = document_.item("skins", skin);
  const Json* joints = document_.list(description, "joints");
  if (joints == nullptr || joints->items.empty()) document_.fail(description, "the skin has no joints");
  std::vector<Matrix4> result;
  for (const Json& value : joints->items) result.push_back(world_[document_.as_index(value, "nodes")]);
  const auto inverse_bind = document_.index(description, "inverseBindMatrices", "accessors");
  if (!inverse_bind) return result;
  const Values matrices = accessors_.floats(*inverse_bind, {"MAT4"});
  if (matrices.count < result.size())
    document_.fail(description, "the skin has " + std::to_string(result.size()) + " joints and only " +
                                    std::to_string(matrices.count) + " inverse bind matrices");
  for (size_t joint = 0; joint < result.size(); ++joint) {
    Matrix4 m;
    for (size_t i = 0; i < 16; ++i) m[i % 4][i / 4] = static_cast<double>(matrices[joint][i]);
    m[3] = identity[3];
    result[joint] = multiply(result[joint], m);
  }
  return result;
}

}  // namespace alhazen::impl::gltf
