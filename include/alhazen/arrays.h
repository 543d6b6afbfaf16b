#pragma once

// Arrays that a scene is made of: meshes and images. A scene copies what it is given, so the arrays may be freed or
// changed after the call. What a scene returns are views into it, valid until that part is replaced, or the scene is
// moved from or destroyed.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// A view of floats or doubles, which must outlive it.
class Reals {
 public:
  Reals() = default;
  Reals(std::span<const float> values) : floats_(values.data()), size_(values.size()) {}    // NOLINT: a view of them
  Reals(std::span<const double> values) : doubles_(values.data()), size_(values.size()) {}  // NOLINT
  Reals(const std::vector<float>& values) : Reals(std::span<const float>(values)) {}        // NOLINT
  Reals(const std::vector<double>& values) : Reals(std::span<const double>(values)) {}      // NOLINT

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  double operator[](size_t i) const { return floats_ ? double{floats_[i]} : doubles_[i]; }

 private:
  const float* floats_ = nullptr;
  const double* doubles_ = nullptr;
  size_t size_ = 0;
};

/// A triangle mesh in object space. All arrays but the first two are optional; they have values for each vertex, all of
/// them finite. Positions are kept in double precision, the others in single.
struct MeshArrays {
  Reals positions{};                    ///< x, y, z of each vertex
  std::span<const uint32_t> indices{};  ///< three vertices of each triangle, counter-clockwise seen from outside
  Reals normals{};                      ///< x, y, z; need not be normalized; absent: triangles are flat
  Reals uvs{}, second_uvs{};            ///< u, v
  Reals colours{};   ///< linear red, green, blue, or also alpha; for VertexColourTexture, VertexAlphaTexture
  Reals tangents{};  ///< x, y, z of the direction of increasing u, and 1 or -1: the handedness of the bitangent
  std::string name{};
};

/// A mesh as the scene holds it: arrays that it was not given are empty.
struct MeshView {
  std::span<const double> positions{};
  std::span<const uint32_t> indices{};
  std::span<const float> normals{}, uvs{}, second_uvs{}, tangents{};
  std::span<const float> colours{};  ///< red, green, blue, alpha
};

/// How bytes of an image stand for values: by the curve of sRGB, or value / 255.
enum class Encoding { srgb, linear };

/// An image in memory, rows from the top down, channels interleaved: 1 (grey), 3 (red, green, blue) or 4 (and alpha).
/// Exactly one of `bytes` and `floats` has width * height * channels values, all of them finite, of at most 2^30
/// texels.
struct Pixels {
  int width = 0, height = 0, channels = 3;
  std::span<const uint8_t> bytes{};
  std::span<const float> floats{};     ///< linear
  Encoding encoding = Encoding::srgb;  ///< of `bytes`
  /// Of 4 channels: takes the fourth, as a grey linear image, instead of the colours. A scene has no images of four
  /// channels: add colours and alpha one after the other.
  bool takes_alpha = false;
  std::string name{};
};

}  // namespace ALHAZEN_NAMESPACE
