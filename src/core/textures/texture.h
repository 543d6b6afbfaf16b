#pragma once

// Evaluates textures: one switch over the kinds, and a stack for nested nodes.

#include "core/scene_view.h"
#include "core/textures/image.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD bool is_even_check(const SceneView<Real>& scene, const TextureRecord<Real>& node,
                              const TexturePoint<Real>& at) {
  const TextureMapping<Real>& mapping = scene.texture_mappings[node.mapping];
  Real cells;
  if (node.octaves) {
    const Vec3<Real> p = map_solid(mapping, at.position);
    cells = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
  } else {
    const Vec2<Real> st = map_texture(scene, mapping, at);
    cells = std::floor(st.x) + std::floor(st.y);
  }
  return cells - 2 * std::floor(cells * Real(0.5)) == 0;
}

/// pbrt's marble: a uniform cubic Bezier spline through nine colours, indexed by veins that noise displaces
/// (PBR 4th ed., 10.5; the colours are constants of pbrt-v4).
template <class Real>
ALHAZEN_HD Vec3<Real> marble(const uint8_t* permutation, const TextureRecord<Real>& node, Vec3<Real> p) {
  p *= node.parameters.y;
  const Real noise = octave_noise(permutation, p, node.parameters.x, node.octaves, false);
  const Real wave = sine_cosine(p.y + node.parameters.z * noise).sine;
  const Real t = wave > -2 ? Real(0.5) + Real(0.5) * wave : Real(0.5);  // wave is NaN if the point is infinite
  const auto colour = [](int i) -> Vec3<Real> {
    switch (i) {
      case 3:
        return {Real(0.5), Real(0.5), Real(0.5)};
      case 4:
        return {Real(0.6), Real(0.59), Real(0.58)};
      case 7:
        return {Real(0.2), Real(0.2), Real(0.33)};
      default:
        return {Real(0.58), Real(0.58), Real(0.6)};
    }
  };
  int first = static_cast<int>(t * 6);
  first = first > 5 ? 5 : first;
  const Real s = t * 6 - static_cast<Real>(first);
  const Vec3<Real> a = lerp(colour(first), colour(first + 1), s);
  const Vec3<Real> b = lerp(colour(first + 1), colour(first + 2), s);
  const Vec3<Real> c = lerp(colour(first + 2), colour(first + 3), s);
  return lerp(lerp(a, b, s), lerp(b, c, s), s) * Real(1.5);
}

/// The value of one node; `inputs` are the values of its input textures.
template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_texture_node(const SceneView<Real>& scene, const TextureRecord<Real>& node,
                                            const TexturePoint<Real>& at, const Vec3<Real>* inputs) {
  switch (node.kind) {
    case TextureKind::constant:
      return node.parameters;
    case TextureKind::checkerboard:
      return is_even_check(scene, node, at) ? inputs[0] : inputs[1];
    case TextureKind::image: {
      const Vec3<Real> value =
          lookup_filtered(scene, node.image, scene.texture_mappings[node.mapping], at) * node.parameters.x;
      return max(node.parameters.y != 0 ? splat(Real(1)) - value : value, Vec3<Real>{});
    }
    case TextureKind::fbm:
    case TextureKind::wrinkled: {
      const Vec3<Real> p = map_solid(scene.texture_mappings[node.mapping], at.position);
      return splat(octave_noise(scene.noise_permutation, p, node.parameters.x, node.octaves,
                                node.kind == TextureKind::wrinkled));
    }
    case TextureKind::marble:
      return marble(scene.noise_permutation, node, map_solid(scene.texture_mappings[node.mapping], at.position));
    case TextureKind::scale:
      return inputs[0] * inputs[1];
    case TextureKind::mix:
      return inputs[0] * (splat(Real(1)) - inputs[2]) + inputs[1] * inputs[2];
    case TextureKind::channel:
      return splat(inputs[0][static_cast<int>(node.octaves)]);
    case TextureKind::threshold: {
      const auto step = [](Real x, Real edge) { return x >= edge ? Real(1) : Real(0); };
      return {step(inputs[0].x, node.parameters.x), step(inputs[0].y, node.parameters.y),
              step(inputs[0].z, node.parameters.z)};
    }
    case TextureKind::vertex_colour:
      return mesh_colour(scene, at.hit).rgb;
    case TextureKind::vertex_alpha:
      return splat(mesh_colour(scene, at.hit).alpha);
    case TextureKind::coordinates: {
      const Vec2<Real> st = map_texture(scene, scene.texture_mappings[node.mapping], at);
      return {st.x, st.y, 0};
    }
    case TextureKind::dots:
      return is_inside_dot(scene.noise_permutation, map_texture(scene, scene.texture_mappings[node.mapping], at))
                 ? inputs[0]
                 : inputs[1];
    case TextureKind::windy:
      return splat(windy_waves(scene.noise_permutation, map_solid(scene.texture_mappings[node.mapping], at.position)));
    case TextureKind::direction_mix:
      return lerp(inputs[1], inputs[0], abs_dot(at.normal, node.parameters));
  }
  return {};
}

ALHAZEN_HD constexpr uint32_t texture_input_count(TextureKind kind) {
  switch (kind) {
    case TextureKind::mix:
      return 3;
    case TextureKind::scale:
    case TextureKind::checkerboard:
    case TextureKind::dots:
    case TextureKind::direction_mix:
      return 2;
    case TextureKind::channel:
    case TextureKind::threshold:
      return 1;
    default:
      return 0;
  }
}

/// Evaluates textures that are not constant. It is not inlined: GPU compilers would copy it into each of its many
/// callers.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD Vec3<Real> evaluate_texture_nodes(const SceneView<Real>& scene, TextureRange range,
                                                          const TexturePoint<Real>& at) {
  const TextureRecord<Real>* nodes = scene.textures + range.first;
  if (range.count == 1) return evaluate_texture_node(scene, nodes[0], at, static_cast<const Vec3<Real>*>(nullptr));
  Vec3<Real> stack[max_texture_stack];
  uint32_t height = 0;
  for (uint32_t i = 0; i < range.count; ++i) {
    height -= texture_input_count(nodes[i].kind);
    stack[height] = evaluate_texture_node(scene, nodes[i], at, stack + height);
    ++height;
  }
  return stack[0];
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> evaluate_texture(const SceneView<Real>& scene, TextureRange range,
                                                   const TexturePoint<Real>& at) {
  const TextureRecord<Real>& first = scene.textures[range.first];
  if (range.count == 1 && first.kind == TextureKind::constant) return first.parameters;
  return evaluate_texture_nodes(scene, range, at);
}

}  // namespace ALHAZEN_CORE
