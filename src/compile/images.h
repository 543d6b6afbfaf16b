#pragma once

// The part of scene compilation that turns images into texels and image pyramids.

#include <map>
#include <tuple>
#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// The image at half the width and half the height (rounded down, at least 1): each texel is the mean of the linear
/// values over its area.
ImageTexels halved(const ImageTexels& image);

/// Halves the largest images, by bytes, until all of them with their pyramids take at most `budget` bytes, and reports
/// that in one warning. 0: no limit.
void fit_images(Scene& scene, uint64_t budget, Diagnostics& diagnostics);

/// Where the texels of an image are, and those of its pyramid if it is filtered.
struct ImagePyramid {
  struct Level {
    uint64_t first;
    uint32_t width, height;
  };
  std::vector<Level> levels;
  bool is_float, is_srgb;
  uint32_t channels;
};

/// By image: whether a texture filters it, and so needs its pyramid.
std::vector<bool> filtered_images(const Scene& scene);

/// Moves the texels of all images out of the scene and makes their records: one for each image and each way that
/// textures sample it, followed by those of its pyramid if it is filtered.
template <class Real>
class ImageBuilder {
 public:
  ImageBuilder(Scene& scene, SceneArrays<Real>& out);
  /// Of images whose texels are in a compiled scene.
  ImageBuilder(std::vector<ImagePyramid> pyramids, SceneArrays<Real>& out);

  /// Index into images of the record for an image texture.
  uint32_t record(const Texture& texture);

  const std::vector<ImagePyramid>& pyramids() const { return pyramids_; }

 private:
  void add(ImageTexels& image, bool with_pyramid);
  ImagePyramid::Level append(const ImageTexels& image);

  SceneArrays<Real>& out_;
  std::vector<ImagePyramid> pyramids_;
  std::map<std::tuple<uint32_t, WrapMode, WrapMode, bool>, uint32_t> records_;
};

}  // namespace alhazen::impl
