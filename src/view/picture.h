#pragma once

// What viewers are shown: a picture that is not changed any more, with all its layers.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"

namespace alhazen::impl {

/// Channels that are shown together: "color" (R, G, B), "alpha", or a layer by the name of docs/layers.md.
struct PictureLayer {
  std::string name;
  std::vector<std::string> channels;       ///< as in files: "R", "normal.X"
  std::vector<std::vector<float>> planes;  ///< width * height values each, rows from the top down
};

struct Picture {
  uint64_t number = 0;                  ///< counts pictures
  uint64_t view = 0;                    ///< of the camera and all else that it shows; a later view has a larger one
  int width = 0, height = 0;            ///< pixels that were rendered
  int full_width = 0, full_height = 0;  ///< of the whole picture at full resolution
  int x = 0, y = 0;                     ///< of the upper left pixel within the whole, in pixels of the latter
  int step = 1;                         ///< pixels at full resolution along each side of one that was rendered
  double samples = 0;                   ///< per pixel, on average
  bool is_final = false;                ///< no more samples are to be taken
  std::vector<PictureLayer> layers;

  const PictureLayer* layer(const std::string& name) const;
};

/// The layer that a channel belongs to: "normal" of "normal.X".
std::string layer_of(const std::string& channel);

/// Takes the planes of an image.
std::shared_ptr<Picture> make_picture(RenderedImage&& image);

}  // namespace alhazen::impl
