#pragma once

// Chooses one of many lights by its estimated contribution to a point: descends a tree of lights, at each node by the
// importance of its two children (Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting"; PBR 4th ed., 12.6.3).

#include "core/scene_view.h"

namespace ALHAZEN_CORE {

/// Sine and cosine of an angle within [0, pi].
template <class Real>
struct AngleOfCone {
  Real sine, cosine;
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT AngleOfCone<Real> angle_of_cosine(Real cosine) {
  return {safe_sqrt(1 - cosine * cosine), cosine};
}

/// Sine and cosine of an angle up to 90 degrees.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT AngleOfCone<Real> angle_of_sine(Real sine) {
  return {sine, safe_sqrt(1 - sine * sine)};
}

/// a - b, clamped to 0.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT AngleOfCone<Real> clamped_difference(const AngleOfCone<Real>& a, const AngleOfCone<Real>& b) {
  if (a.cosine > b.cosine) return {0, 1};
  return {a.sine * b.cosine - a.cosine * b.sine, a.cosine * b.cosine + a.sine * b.sine};
}

/// A bound, up to a factor common to all nodes, on the light that the node sends to `point` from anywhere in its sphere
/// and for any normal in its cone. `normal` is that of the side from which light must arrive; zero means any side.
/// The bound is 0 only if no light can arrive, up to rounding.
template <class Real>
ALHAZEN_HD Real light_importance(const LightTreeNode& node, const Vec3<Real>& point, const Vec3<Real>& normal) {
  const Vec3<Real> to_point = point - convert<Real>(node.centre);
  const Real distance_squared = length_squared(to_point);
  const Real radius = static_cast<Real>(node.radius);
  const Real power = static_cast<Real>(node.power);
  // Inside the sphere light may arrive from anywhere. A point on the sphere counts as inside, within the distance
  // by which a ray's origin is offset from a surface: if the node is one emissive sphere, sampling has its point
  // rounded to one side, and the density query to the other.
  const Real slack = (max_component(abs(point)) + radius) * rounding_bound<Real>(32);
  if (distance_squared <= (radius > 0 ? sqr(radius + slack) : Real(0)))
    return radius > 0 ? power / sqr(radius) : Real(0);
  const Real per_distance = 1 / std::sqrt(distance_squared);
  const Vec3<Real> outgoing = to_point * per_distance;
  const AngleOfCone<Real> sphere = angle_of_sine(radius * per_distance);
  Real importance = power * sqr(per_distance);
  if (node.cos_normals > -1) {
    const Real along_axis = clamp(dot(convert<Real>(node.axis), outgoing), Real(-1), Real(1));
    const AngleOfCone<Real> from_axis = angle_of_cosine(node.is_two_sided() ? std::abs(along_axis) : along_axis);
    const AngleOfCone<Real> normals{static_cast<Real>(node.sin_normals), static_cast<Real>(node.cos_normals)};
    const Real cos_least = clamped_difference(clamped_difference(from_axis, normals), sphere).cosine;
    if (!(cos_least > static_cast<Real>(node.cos_emission))) return 0;
    importance *= cos_least;
  }
  if (!is_zero(normal)) {
    const AngleOfCone<Real> incident = angle_of_cosine(clamp(-dot(outgoing, normal), Real(-1), Real(1)));
    importance *= clamped_difference(incident, sphere).cosine;
  }
  return importance > 0 ? importance : Real(0);
}

/// The probability of choosing the first of the two children at `first`; negative if neither can contribute.
template <class Real>
ALHAZEN_HD Real first_child_probability(const SceneView<Real>& scene, uint32_t first, const Vec3<Real>& point,
                                        const Vec3<Real>& normal) {
  const Real a = light_importance(scene.light_tree[first], point, normal);
  const Real b = light_importance(scene.light_tree[first + 1], point, normal);
  return a + b > 0 ? a / (a + b) : Real(-1);
}

/// The minimum probability with which the light tree, or the lights at infinity, are chosen where both contribute:
/// either may turn out to be hidden. That of the tree falls to 0 where less than a hundredth of the light is from the
/// tree, so that rounding of the point changes it little.
inline constexpr double min_group_probability = 0.2;

/// The probability of choosing a light by the tree, not one at infinity: by the irradiance that each can cause at
/// `point`.
template <class Real>
ALHAZEN_HD Real light_tree_probability(const SceneView<Real>& scene, const Vec3<Real>& point,
                                       const Vec3<Real>& normal) {
  if (scene.light_tree_count == 0) return 0;
  if (scene.infinite_irradiance == 0) return 1;
  const LightTreeNode& root = scene.light_tree[0];
  const Real importance = root.is_leaf() ? light_importance(root, point, normal)
                                         : light_importance(scene.light_tree[root.index()], point, normal) +
                                               light_importance(scene.light_tree[root.index() + 1], point, normal);
  if (!(importance > 0)) return 0;
  // The importance is that of surfaces that emit the power on one side, which is pi times their intensity along the
  // normal; of other lights it is up to 4 times their irradiance.
  const Real ratio = pi<Real> * scene.infinite_irradiance / importance;
  const Real lowest = Real(min_group_probability) / (1 + ratio * Real(0.01));
  return min(max(1 / (1 + ratio), lowest), Real(1 - min_group_probability));
}

template <class Real>
struct LightChoice {
  uint32_t light = no_light;
  Real pmf = 0;
  Real u = 0;  ///< the random number of the choice, rescaled to [0, 1): it is uniform for each light
};

/// Chooses one light of the tree for `point`; no light if none can contribute.
template <class Real>
ALHAZEN_HD LightChoice<Real> sample_light_tree(const SceneView<Real>& scene, const Vec3<Real>& point,
                                               const Vec3<Real>& normal, Real u) {
  const LightTreeNode* node = scene.light_tree;
  Real pmf = 1;
  while (!node->is_leaf()) {
    const Real p = first_child_probability(scene, node->index(), point, normal);
    if (p < 0) return {};
    const bool second = u >= p;
    u = min(second ? (u - p) / (1 - p) : u / p, one_minus_epsilon<Real>);
    pmf *= second ? 1 - p : p;
    node = scene.light_tree + node->index() + (second ? 1 : 0);
  }
  return {node->index(), pmf, u};
}

/// The probability that `sample_light_tree` chooses the light at `trail`.
template <class Real>
ALHAZEN_HD Real pmf_of_light_tree(const SceneView<Real>& scene, uint32_t trail, const Vec3<Real>& point,
                                  const Vec3<Real>& normal) {
  const LightTreeNode* node = scene.light_tree;
  Real pmf = 1;
  for (; !node->is_leaf(); trail >>= 1) {
    const Real p = first_child_probability(scene, node->index(), point, normal);
    const bool second = trail & 1;
    const Real probability = second ? 1 - p : p;
    if (p < 0 || !(probability > 0)) return 0;
    pmf *= probability;
    node = scene.light_tree + node->index() + (second ? 1 : 0);
  }
  return pmf;
}

}  // namespace ALHAZEN_CORE
