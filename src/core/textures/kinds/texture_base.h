#pragma once

// What every kind of texture node has, with defaults.

#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// What a kind is evaluated over. Kinds over anything but `none` have a mapping.
enum class TextureDomain : uint32_t {
  none,
  st,           ///< the (s, t) of the mapping
  space,        ///< the point in texture space
  st_or_space,  ///< texture space if the node's number is not 0
};

/// The base of the kinds. Each adds
///   template <class Real, class Node>
///   static Vec3<Real> evaluate(const Node& node, const Vec3<Real>* inputs);
/// its value at a point, where `node` is a TextureNode (core/textures/texture.h) and `inputs` are the values of its
/// input textures.
struct TextureBase {
  static constexpr uint32_t input_count = 0;
  static constexpr TextureDomain domain = TextureDomain::none;

  /// The three numbers and the whole number that a node stores, from a described texture (scene/scene.h).
  template <class Description>
  static Vec3d parameters(const Description& texture) {
    return texture.value;
  }
  template <class Description>
  static int number(const Description&) {
    return 0;
  }
};

}  // namespace ALHAZEN_CORE
