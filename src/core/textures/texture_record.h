#pragma once

// The records of textures: small programs in postfix order.

#include <cstdint>

#include "core/math/vec.h"
#include "core/textures/mapping_kind.h"
#include "core/textures/texture_list.h"

namespace ALHAZEN_CORE {

/// A texture is `count` nodes from `first` in SceneView::textures, inputs before the nodes that use them; the last
/// node gives its value. A count of 0 means no texture.
struct TextureRange {
  uint32_t first = 0;
  uint32_t count = 0;
};

/// Maximum number of values on the evaluation stack.
inline constexpr uint32_t max_texture_stack = 8;

template <class Real>
struct TextureRecord {
  TextureKind kind;
  uint32_t mapping;  ///< index into texture_mappings, for kinds that have a domain
  uint32_t image;    ///< image: index into images
  uint32_t number;   ///< this and `parameters`: as the file of the kind says
  Vec3<Real> parameters;
};

template <class Real>
struct TextureMapping {
  Real st_of_uv[2][3];  ///< rows of (s, t) over (u, v, 1)
  TextureMappingKind kind;
  uint32_t uv_set;  ///< 0: the surface's own; 1: the second of meshes
  /// From world space to texture space, rows of a 3x4 matrix.
  Real texture_from_world[3][4];
};

/// Texels start at `first` in texel_bytes or texel_floats, with one or three channels each, rows from the top of the
/// image down. The records of its pyramid levels follow, each half as large as the previous one.
struct ImageRecord {
  uint64_t first;
  uint32_t width, height;
  uint32_t is_float;
  uint32_t is_srgb;         ///< bytes only: decoded by srgb_decode_table
  uint32_t wrap_s, wrap_t;  ///< WrapMode
  uint32_t nearest;         ///< 1: nearest texel, 0: bilinear
  uint32_t channels;        ///< 1 or 3
  uint32_t levels;          ///< number of records of the image: this one and the smaller levels
  uint32_t unused;
};

}  // namespace ALHAZEN_CORE
