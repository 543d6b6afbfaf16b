#pragma once

// Evaluation of textures: one switch over the kinds, a stack for nodes over nodes.

#include "core/scene_view.h"
#include "core/textures/noise.h"

namespace ALHAZEN_CORE {

/// Where a texture is looked up.
template <class Real>
struct TexturePoint {
  Vec3<Real> position;  ///< world space
  Vec2<Real> uv;
};

template <class Real>
ALHAZEN_HD Vec2<Real> map_uv(const TextureMapping<Real>& m, const Vec2<Real>& uv) {
  return {m.u_scale * uv.x + m.u_offset, m.v_scale * uv.y + m.v_offset};
}

template <class Real>
ALHAZEN_HD Vec3<Real> map_solid(const TextureMapping<Real>& m, const Vec3<Real>& p) {
  const auto row = [&](int i) {
    const Real* r = m.texture_from_world[i];
    return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
  };
  return {row(0), row(1), row(2)};
}

template <class Real>
ALHAZEN_HD Vec3<Real> fetch_texel(const SceneView<Real>& scene, const ImageRecord& image, int x, int y) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (x < 0 || y < 0 || x >= width || y >= height) {
    switch (static_cast<WrapMode>(image.wrap)) {
      case WrapMode::black:
        return {};
      case WrapMode::clamp:
        x = x < 0 ? 0 : x >= width ? width - 1 : x;
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
        break;
      case WrapMode::repeat:
        x %= width, y %= height;
        x += x < 0 ? width : 0, y += y < 0 ? height : 0;
        break;
      case WrapMode::mirror:
        x %= 2 * width, y %= 2 * height;
        x += x < 0 ? 2 * width : 0, y += y < 0 ? 2 * height : 0;
        x = x < width ? x : 2 * width - 1 - x, y = y < height ? y : 2 * height - 1 - y;
        break;
    }
  }
  const uint64_t texel = image.first + 3 * (static_cast<uint64_t>(y) * image.width + static_cast<uint64_t>(x));
  if (image.is_float) {
    const float* t = scene.texel_floats + texel;
    return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
  }
  const uint8_t* t = scene.texel_bytes + texel;
  const Real* table = scene.srgb_decode_table + (image.is_srgb ? 0 : 256);
  return {table[t[0]], table[t[1]], table[t[2]]};
}

/// The picture at (s, t), t upwards, texel centres at half integers.
template <class Real>
ALHAZEN_HD Vec3<Real> lookup_image(const SceneView<Real>& scene, const ImageRecord& image, const Vec2<Real>& st) {
  if (!(std::abs(st.x) < Real(1e6) && std::abs(st.y) < Real(1e6))) return {};
  const Real x = st.x * static_cast<Real>(image.width), y = (1 - st.y) * static_cast<Real>(image.height);
  if (image.nearest) return fetch_texel(scene, image, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  const Real fx = std::floor(x - Real(0.5)), fy = std::floor(y - Real(0.5));
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const Real wx = x - Real(0.5) - fx, wy = y - Real(0.5) - fy;
  const Vec3<Real> top = lerp(fetch_texel(scene, image, ix, iy), fetch_texel(scene, image, ix + 1, iy), wx);
  const Vec3<Real> bottom = lerp(fetch_texel(scene, image, ix, iy + 1), fetch_texel(scene, image, ix + 1, iy + 1), wx);
  return lerp(top, bottom, wy);
}

template <class Real>
ALHAZEN_HD bool is_even_check(const SceneView<Real>& scene, const TextureRecord<Real>& node,
                              const TexturePoint<Real>& at) {
  const TextureMapping<Real>& mapping = scene.texture_mappings[node.mapping];
  Real cells;
  if (node.octaves) {
    const Vec3<Real> p = map_solid(mapping, at.position);
    cells = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
  } else {
    const Vec2<Real> st = map_uv(mapping, at.uv);
    cells = std::floor(st.x) + std::floor(st.y);
  }
  return cells - 2 * std::floor(cells * Real(0.5)) == 0;
}

/// pbrt's marble: a uniform cubic Bezier spline through nine colours, run through by veins that noise displaces
/// (PBR 4th ed., 10.5; the colours are figures of pbrt-v4's format).
template <class Real>
ALHAZEN_HD Vec3<Real> marble(const uint8_t* permutation, const TextureRecord<Real>& node, Vec3<Real> p) {
  p *= node.parameters.y;
  const Real noise = octave_noise(permutation, p, node.parameters.x, node.octaves, false);
  const Real t = Real(0.5) + Real(0.5) * sine_cosine(p.y + node.parameters.z * noise).sine;
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

/// The value of one node; `inputs` are the values of the textures that it takes.
template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_texture_node(const SceneView<Real>& scene, const TextureRecord<Real>& node,
                                            const TexturePoint<Real>& at, const Vec3<Real>* inputs) {
  switch (node.kind) {
    case TextureKind::constant:
      return node.parameters;
    case TextureKind::checkerboard:
      return is_even_check(scene, node, at) ? inputs[0] : inputs[1];
    case TextureKind::image: {
      const Vec2<Real> st = map_uv(scene.texture_mappings[node.mapping], at.uv);
      const Vec3<Real> value = lookup_image(scene, scene.images[node.image], st) * node.parameters.x;
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
    case TextureKind::vertex_alpha:
      return splat(Real(1));
  }
  return {};
}

ALHAZEN_HD constexpr uint32_t texture_input_count(TextureKind kind) {
  return kind == TextureKind::mix                                          ? 3
         : kind == TextureKind::scale || kind == TextureKind::checkerboard ? 2
         : kind == TextureKind::channel || kind == TextureKind::threshold  ? 1
                                                                           : 0;
}

template <class Real>
ALHAZEN_HD Vec3<Real> evaluate_texture(const SceneView<Real>& scene, TextureRange range, const TexturePoint<Real>& at) {
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

}  // namespace ALHAZEN_CORE
