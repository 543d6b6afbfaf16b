#pragma once

// Images: texels, bilinear interpolation, and image pyramids for minification (Williams 1983, "Pyramidal Parametrics").

#include "core/textures/mapping.h"

namespace ALHAZEN_CORE {

/// The texel of a row or column of `size` texels for index `i`, or -1 if there is none.
ALHAZEN_HD inline int wrapped_texel(int i, int size, uint32_t wrap) {
  if (i >= 0 && i < size) return i;
  switch (static_cast<WrapMode>(wrap)) {
    case WrapMode::black:
      return -1;
    case WrapMode::clamp:
      return i < 0 ? 0 : size - 1;
    case WrapMode::repeat:
      i %= size;
      return i < 0 ? i + size : i;
    case WrapMode::mirror: {
      const int64_t period = 2 * int64_t{size};  // a side may have 2^30 texels
      int64_t within = i % period;
      within += within < 0 ? period : 0;
      return static_cast<int>(within < size ? within : period - 1 - within);
    }
  }
  return -1;
}

/// The texel at column x and row y, which are within the image, or black if one of them is -1.
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE Vec3<Real> fetch_texel(const SceneView<Real>& scene, const ImageRecord& image, int x, int y) {
  if ((x | y) < 0) return {};
  const uint64_t texel =
      image.first + image.channels * (static_cast<uint64_t>(y) * image.width + static_cast<uint64_t>(x));
  if (image.is_float) {
    const float* t = scene.texel_floats + texel;
    if (image.channels == 1) return splat(static_cast<Real>(t[0]));
    return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
  }
  const uint8_t* t = scene.texel_bytes + texel;
  const Real* table = scene.srgb_decode_table + (image.is_srgb ? 0 : 256);
  if (image.channels == 1) return splat(table[t[0]]);
  return {table[t[0]], table[t[1]], table[t[2]]};
}

/// The image at (s, t), t upwards; texel centres are at half integers.
template <class Real>
ALHAZEN_HD Vec3<Real> lookup_image(const SceneView<Real>& scene, const ImageRecord& image, const Vec2<Real>& st) {
  if (!(std::abs(st.x) < Real(1e6) && std::abs(st.y) < Real(1e6))) return {};
  const Real x = st.x * static_cast<Real>(image.width), y = (1 - st.y) * static_cast<Real>(image.height);
  if (!(std::abs(x) < Real(2e9) && std::abs(y) < Real(2e9))) return {};
  const auto column = [&](int i) { return wrapped_texel(i, static_cast<int>(image.width), image.wrap_s); };
  const auto row = [&](int i) { return wrapped_texel(i, static_cast<int>(image.height), image.wrap_t); };
  if (image.nearest)
    return fetch_texel(scene, image, column(static_cast<int>(std::floor(x))), row(static_cast<int>(std::floor(y))));
  const Real fx = std::floor(x - Real(0.5)), fy = std::floor(y - Real(0.5));
  const Real wx = x - Real(0.5) - fx, wy = y - Real(0.5) - fy;
  const int x0 = column(static_cast<int>(fx)), x1 = column(static_cast<int>(fx) + 1);
  const int y0 = row(static_cast<int>(fy)), y1 = row(static_cast<int>(fy) + 1);
  if (ALHAZEN_UNLIKELY(image.is_float || (x0 | x1 | y0 | y1) < 0)) {
    const Vec3<Real> top = lerp(fetch_texel(scene, image, x0, y0), fetch_texel(scene, image, x1, y0), wx);
    const Vec3<Real> bottom = lerp(fetch_texel(scene, image, x0, y1), fetch_texel(scene, image, x1, y1), wx);
    return lerp(top, bottom, wy);
  }
  const Real* table = scene.srgb_decode_table + (image.is_srgb ? 0 : 256);
  const uint8_t* texels = scene.texel_bytes + image.first;
  const auto texel = [&](int i, int j) {
    return texels + image.channels * (static_cast<uint64_t>(j) * image.width + static_cast<uint64_t>(i));
  };
  const uint8_t *t00 = texel(x0, y0), *t10 = texel(x1, y0), *t01 = texel(x0, y1), *t11 = texel(x1, y1);
  const auto channel = [&](int c) {
    return lerp(lerp(table[t00[c]], table[t10[c]], wx), lerp(table[t01[c]], table[t11[c]], wx), wy);
  };
  if (image.channels == 1) return splat(channel(0));
  return {channel(0), channel(1), channel(2)};
}

/// Base-2 logarithm of x >= 1, linear between powers of two: continuous, with the same bits everywhere, and too low by
/// at most 0.09.
ALHAZEN_HD inline float coarse_log2(float x) {
  const uint32_t bits = __builtin_bit_cast(uint32_t, x);
  return static_cast<float>(bits >> 23) - 127 + (__builtin_bit_cast(float, (bits & 0x7fffffu) | 0x3f800000u) - 1);
}

/// Pyramid level at which a texel has the area that a quarter of a pixel sees. Using the area keeps detail along the
/// other direction at grazing angles. It is not above 0 if nothing is minified.
template <class Real>
ALHAZEN_HD float pyramid_level(const SceneView<Real>& scene, const ImageRecord& image, const TextureMapping<Real>& m,
                               const TexturePoint<Real>& at) {
  Real& footprint = at.known.footprint;
  if (footprint < 0) footprint = pixel_footprint(scene.camera, at.position, at.normal);
  if (!(footprint > 0)) return 0;
  const Real density =
      m.kind == TextureMappingKind::uv ? density_of_uv(scene, m, at) : density_of_position(m, at, footprint);
  const Real texels = footprint * density * static_cast<Real>(image.width) * static_cast<Real>(image.height);
  if (!(texels > 1)) return 0;
  return 0.5f * coarse_log2(static_cast<float>(min(texels, Real(1e30))));
}

/// The image filtered for the camera: bilinear where magnified, else interpolated between two levels of its pyramid.
/// Surfaces seen by reflection or refraction are filtered as if seen directly.
template <class Real>
ALHAZEN_HD Vec3<Real> lookup_filtered(const SceneView<Real>& scene, uint32_t index, const TextureMapping<Real>& m,
                                      const TexturePoint<Real>& at) {
  const ImageRecord* image = scene.images + index;
  const Vec2<Real> st = map_texture(scene, m, at);
  if (image->levels == 1 || is_zero(at.normal)) return lookup_image(scene, *image, st);
  const float level = pyramid_level(scene, *image, m, at);
  if (!(level > 0)) return lookup_image(scene, *image, st);
  const uint32_t last = image->levels - 1, below = static_cast<uint32_t>(level);
  if (below >= last) return lookup_image(scene, image[last], st);
  const Real weight = static_cast<Real>(level - static_cast<float>(below));
  return lerp(lookup_image(scene, image[below], st), lookup_image(scene, image[below + 1], st), weight);
}

}  // namespace ALHAZEN_CORE
