#pragma once

// How textures lie in memory: small programs in postorder.

#include <cstdint>

#include "core/math/vec.h"
#include "core/textures/functions.h"

namespace ALHAZEN_CORE {

/// A texture is `count` nodes from `first` in SceneView::textures, inputs before the nodes that take them; the last
/// node is its value. count 0: absent.
struct TextureRange {
  uint32_t first = 0;
  uint32_t count = 0;
};

/// How many values may wait on the stack while a texture is evaluated.
inline constexpr uint32_t max_texture_stack = 8;

template <class Real>
struct TextureRecord {
  TextureKind kind;
  uint32_t mapping;  ///< index into texture_mappings, of kinds that look at the surface or at space
  uint32_t image;    ///< image: index into images
  uint32_t octaves;  ///< fbm, wrinkled, marble; checkerboard: 1 if solid
  /// constant: the value. image: x = factor, y = 1 if inverted. noise: x = roughness, y = scale, z = variation.
  /// direction_mix: the direction.
  Vec3<Real> parameters;
};

template <class Real>
struct TextureMapping {
  Real st_of_uv[2][3];  ///< rows of (s, t) over (u, v, 1)
  TextureMappingKind kind;
  uint32_t uv_set;  ///< 0: that of the surface; 1: the second of meshes
  /// From world space to the space of a solid texture, rows of a 3x4 matrix.
  Real texture_from_world[3][4];
};

/// Texels lie from `first` in texel_bytes or texel_floats, one or three channels each, rows from the top of the picture
/// down. The records of smaller versions of the picture follow, each half as large as the one before.
struct ImageRecord {
  uint64_t first;
  uint32_t width, height;
  uint32_t is_float;
  uint32_t is_srgb;         ///< bytes only: decode by srgb_decode_table
  uint32_t wrap_s, wrap_t;  ///< WrapMode
  uint32_t nearest;         ///< 1: nearest texel, 0: bilinear
  uint32_t channels;        ///< 1 or 3
  uint32_t levels;          ///< how many records there are of the picture, this one and smaller ones
  uint32_t unused;
};

}  // namespace ALHAZEN_CORE
