#include "compile/light_tree_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/math/bounds.h"
#include "core/shapes/interaction.h"

namespace alhazen::impl {

namespace {

constexpr double pi_ = std::numbers::pi;

/// A cone of directions about an axis.
struct Cone {
  Vec3d axis{0, 0, 1};
  double angle = -1;  ///< negative: empty
};

Cone joined(const Cone& a, const Cone& b) {
  if (a.angle < b.angle) return joined(b, a);
  if (b.angle < 0 || a.angle >= pi_) return a;
  const double cosine = std::clamp(dot(a.axis, b.axis), -1.0, 1.0);
  if (b.angle == 0 && a.angle == 0 && cosine >= 1 - 1e-12) return a;
  const double between = std::acos(cosine);
  if (between + b.angle <= a.angle) return a;
  const double angle = (a.angle + between + b.angle) / 2;
  const Vec3d across = b.axis - a.axis * cosine;
  if (angle >= pi_ || !(length_squared(across) > 1e-24)) return {a.axis, pi_};
  const double turn = angle - a.angle;
  return {normalize(a.axis * std::cos(turn) + normalize(across) * std::sin(turn)), angle};
}

/// Bounds of a group of lights.
struct LightBounds {
  Bounds3<double> box;
  Cone normals;
  double emission = 0;  ///< angle about a normal that bounds the emission
  double power = 0;
  bool two_sided = false;

  void extend(const LightBounds& b) {
    box.extend(b.box);
    normals = joined(normals, b.normals);
    emission = std::max(emission, b.emission);
    power += b.power;
    two_sided = two_sided || b.two_sided;
  }

  /// The surface area orientation heuristic: power times a measure of the emission cone times the size (Estevez, Kulla
  /// 2018, equation 1). The size does not vanish if the lights are on a line.
  double cost() const {
    const double o = normals.angle, w = std::min(o + emission, pi_);
    const double directions = 2 * pi_ * (1 - std::cos(o)) +
                              pi_ / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    return power * directions * (box.half_area() + 1e-3 * length_squared(box.diagonal()));
  }
};

struct Item {
  LightBounds bounds;
  Vec3d centre;
  double radius;
  uint32_t light;
};

template <class Real>
Item item_of(const LightRecord<Real>& light, const SceneView<Real>& view, uint32_t index, double power) {
  Item item{};
  item.light = index;
  LightBounds& b = item.bounds;
  b.power = power;
  b.two_sided = light.two_sided != 0;
  b.emission = pi_ / 2;
  b.normals = {{0, 0, 1}, pi_};
  const auto add_ball = [&](const Vec3d& centre, double radius) {
    b.box.extend(centre - splat(radius));
    b.box.extend(centre + splat(radius));
    item.radius = std::max(item.radius, radius);
  };
  const auto add_point = [&](const LightCone& cone) {
    if (cone.normals < pi_) b.normals = {convert<double>(light.direction), cone.normals};
    b.emission = cone.emission;
    add_ball(convert<double>(light.position), 0);
  };
  switch (light.kind) {
    case LightKind::triangle: {
      const TriangleRecord& triangle = view.triangles[light.primitive];
      for (const uint32_t v : triangle.vertex) b.box.extend(convert<double>(view.positions[v]));
      b.normals = {normalize(convert<double>(triangle_front_normal(view, triangle))), 0};
      break;
    }
    case LightKind::sphere: {
      const SphereRecord<Real>& s = view.spheres[light.primitive];
      add_ball(convert<double>(s.centre), static_cast<double>(s.radius));
      break;
    }
    case LightKind::moving_sphere: {
      const MovingSphereRecord<Real>& s = view.moving_spheres[light.primitive];
      add_ball(convert<double>(s.centre), static_cast<double>(s.radius));
      add_ball(convert<double>(s.centre + s.motion), static_cast<double>(s.radius));
      item.radius += length(convert<double>(s.motion)) / 2;
      break;
    }
#define ALHAZEN_CASE(name, Name)               \
  case LightKind::name:                        \
    add_point(Name##Light::cone(view, light)); \
    break;
      ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  item.centre = b.box.centre();
  if (light.kind == LightKind::triangle) item.radius = length(b.box.diagonal()) / 2;
  return item;
}

LightTreeNode node_of(const LightBounds& b, const Vec3d& centre, double radius) {
  LightTreeNode node{};
  node.centre = convert<float>(centre);
  // Enlarged by the rounding error of the centre.
  const double moved = 4e-7 * max_component(abs(centre));
  node.radius = radius > 0 ? static_cast<float>(radius * (1 + 1e-6) + moved) : 0.0f;
  node.axis = convert<float>(b.normals.axis);
  node.sin_normals = static_cast<float>(std::sin(b.normals.angle));
  node.cos_normals = static_cast<float>(std::cos(b.normals.angle));
  node.cos_emission = b.emission >= pi_ / 2 ? 0.0f : static_cast<float>(std::cos(b.emission));
  node.power = static_cast<float>(b.power);
  node.bits = b.two_sided ? LightTreeNode::two_sided : 0;
  return node;
}

constexpr int buckets = 12;

int bucket_of(const Item& item, int axis, const Bounds3<double>& centres) {
  const double place = (item.centre[axis] - centres.low[axis]) / centres.diagonal()[axis];
  return std::clamp(static_cast<int>(place * buckets), 0, buckets - 1);
}

struct LightSplit {
  int axis = -1;   ///< negative: none
  int bucket = 0;  ///< last bucket of the first child
  double cost = infinity<double>;
};

/// Finds the cheapest plane between buckets along `axis`.
void find_split(const Item* items, size_t count, int axis, const Bounds3<double>& centres, LightSplit& best) {
  const Vec3d size = centres.diagonal();
  if (!(size[axis] > 0)) return;
  std::array<LightBounds, buckets> bounds;
  for (size_t i = 0; i < count; ++i)
    bounds[static_cast<size_t>(bucket_of(items[i], axis, centres))].extend(items[i].bounds);
  std::array<double, buckets> costs_above{};
  LightBounds above, below;
  for (size_t i = buckets - 1; i > 0; --i) {
    if (bounds[i].power > 0) above.extend(bounds[i]);
    costs_above[i] = above.power > 0 ? above.cost() : -1;
  }
  const double thinness = max_component(size) / size[axis];
  for (size_t i = 0; i + 1 < buckets; ++i) {
    if (bounds[i].power > 0) below.extend(bounds[i]);
    if (!(below.power > 0) || costs_above[i + 1] < 0) continue;
    const double cost = thinness * (below.cost() + costs_above[i + 1]);
    if (cost < best.cost) best = {axis, static_cast<int>(i), cost};
  }
}

/// Builds the tree in place. The 2 n - 2 descendants of a group of n lights are contiguous, so threads can build them.
class LightTreeBuilder {
 public:
  LightTreeBuilder(std::vector<Item>& items, std::vector<LightTreeNode>& nodes, std::vector<uint32_t>& trails)
      : items_(items), nodes_(nodes), trails_(trails) {}

  LightBounds build(size_t first, size_t count, uint32_t node, uint32_t descendants, uint32_t depth, uint32_t trail) {
    Item* items = &items_[first];
    if (count == 1) {
      nodes_[node] = node_of(items->bounds, items->centre, items->radius);
      nodes_[node].bits |= items->light << 2 | LightTreeNode::leaf;
      trails_[items->light] = trail;
      return items->bounds;
    }
    const size_t left = partition(items, count, depth);
    const auto left_nodes = static_cast<uint32_t>(2 * left - 2);
    LightBounds a, b;
    const auto build_second = [&] {
      b = build(first + left, count - left, descendants + 1, descendants + 2 + left_nodes, depth + 1,
                trail | 1u << depth);
    };
    const auto build_first = [&] { a = build(first, left, descendants, descendants + 2, depth + 1, trail); };
    if (count > 4096) {
#pragma omp task default(shared)
      build_first();
      build_second();
#pragma omp taskwait
    } else {
      build_first();
      build_second();
    }
    a.extend(b);
    nodes_[node] = node_of(a, a.box.centre(), length(a.box.diagonal()) / 2);
    nodes_[node].bits |= descendants << 2;
    return a;
  }

 private:
  /// Returns whether this many lights fit below a node of that depth.
  static bool fits(size_t count, uint32_t depth) {
    return static_cast<uint32_t>(std::bit_width(count - 1)) + depth <= max_light_tree_depth;
  }

  /// Moves the lights of the first child before the others and returns their number.
  static size_t partition(Item* items, size_t count, uint32_t depth) {
    Bounds3<double> centres;
    for (size_t i = 0; i < count; ++i) centres.extend(items[i].centre);
    LightSplit split;
    if (count > 2)
      for (int axis = 0; axis < 3; ++axis) find_split(items, count, axis, centres, split);
    if (split.axis >= 0) {
      const Item* middle = std::stable_partition(
          items, items + count, [&](const Item& i) { return bucket_of(i, split.axis, centres) <= split.bucket; });
      const auto left = static_cast<size_t>(middle - items);
      if (left > 0 && left < count && fits(std::max(left, count - left), depth + 1)) return left;
    }
    const int axis = max_axis(centres.diagonal());
    std::stable_sort(items, items + count,
                     [axis](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
    return count / 2;
  }

  std::vector<Item>& items_;
  std::vector<LightTreeNode>& nodes_;
  std::vector<uint32_t>& trails_;
};

}  // namespace

template <class Real>
void build_light_tree(const std::vector<double>& weights, const SceneView<Real>& shapes, SceneArrays<Real>& out) {
  std::vector<Item> items;
  for (uint32_t i = 0; i < out.lights.size(); ++i) {
    if (!light_traits(out.lights[i].kind).is_at_infinity && weights[i] > 0)
      items.push_back(item_of(out.lights[i], shapes, i, weights[i]));
  }
  // The root, one unused node, and the pairs of children.
  std::vector<LightTreeNode> nodes(2 * items.size());
  std::vector<uint32_t> trails(out.lights.size());
  LightTreeBuilder builder(items, nodes, trails);
#pragma omp parallel if (items.size() > 8192)
#pragma omp single
  builder.build(0, items.size(), 0, 2, 0, 0);
  for (size_t i = 0; i < trails.size(); ++i) out.lights[i].trail = trails[i];
  out.light_tree = std::move(nodes);
}

template void build_light_tree(const std::vector<double>&, const SceneView<float>&, SceneArrays<float>&);
template void build_light_tree(const std::vector<double>&, const SceneView<double>&, SceneArrays<double>&);

}  // namespace alhazen::impl
