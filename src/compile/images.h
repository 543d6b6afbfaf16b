#pragma once

// The part of compiling that turns pictures into texels and pyramids of them.

#include <map>
#include <tuple>
#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// The picture in half the width and half the height (rounded down, at least 1): each texel is the mean, of linear
/// values, over the area that it stands for.
ImageTexels halved(const ImageTexels& image);

/// Halves the largest pictures, by bytes, until all of them with their pyramids take at most `budget` bytes, and says
/// so in one warning. 0: no limit.
void fit_images(Scene& scene, uint64_t budget, Diagnostics& diagnostics);

/// Texels of all pictures of the scene, which are freed there, and records of them: one for each picture and each way
/// that textures look it up, with those of its pyramid behind it where it is filtered.
template <class Real>
class ImageBuilder {
 public:
  ImageBuilder(Scene& scene, SceneArrays<Real>& out);

  /// Index into images of the record for a texture of kind image.
  uint32_t record(const Texture& texture);

 private:
  struct Level {
    uint64_t first;
    uint32_t width, height;
  };
  struct Picture {
    std::vector<Level> levels;
    bool is_float, is_srgb;
    uint32_t channels;
  };
  void add(ImageTexels& image, bool with_pyramid);
  Level append(const ImageTexels& image);

  SceneArrays<Real>& out_;
  std::vector<Picture> pictures_;
  std::map<std::tuple<uint32_t, WrapMode, WrapMode, bool>, uint32_t> records_;
};

}  // namespace alhazen
