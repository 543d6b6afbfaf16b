#pragma once

// Pictures as binary messages for viewers.
//
// A message is "ALHF", the length of a header as 32 bits (little-endian), the header as JSON, padded by spaces to a
// multiple of 4 bytes, and a payload, compressed by raw deflate (RFC 1951). The payload holds tiles of 64 x 64 pixels,
// fewer at the right and the bottom, in row order; of each tile its channels; and of each channel its bytes, from the
// least significant one on: that byte of all pixels of the tile. Bytes of one significance are more alike than those of
// one value, and compress better.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/picture.h"

namespace alhazen::impl {

enum class FrameType { half, single };

/// What is told beside a picture.
struct FrameLabel {
  uint64_t frame = 0;                 ///< number that the viewer acknowledges
  std::optional<uint64_t> camera_id;  ///< of the viewer's message whose camera is seen
};

/// A layer of a picture. Tiles are compressed when a frame needs them first, and each only once, whichever frames and
/// viewers they are for. Used by one thread at a time.
class EncodedLayer {
 public:
  static constexpr int tile_size = 64;

  /// `layer` belongs to the picture.
  EncodedLayer(std::shared_ptr<const Picture> picture, const PictureLayer& layer, FrameType type);

  const Picture& picture() const { return *picture_; }
  const PictureLayer& layer() const { return layer_; }
  FrameType type() const { return type_; }

  /// The message for a viewer that has been sent `previous` as its last frame of this layer (null: it has none). Only
  /// tiles that differ from it are sent, if it has the same size and type.
  std::string frame(const FrameLabel& label, const EncodedLayer* previous);

 private:
  struct Tile {
    size_t begin, size;  ///< in bytes_
    std::string compressed;
  };

  void add_tile(int x0, int y0);
  bool is_comparable(const EncodedLayer& other) const;
  std::vector<size_t> changed_tiles(const EncodedLayer& previous) const;
  std::string header(const FrameLabel& label, const std::vector<size_t>& sent, size_t bytes) const;
  void compress(const std::vector<size_t>& tiles);

  std::shared_ptr<const Picture> picture_;
  const PictureLayer& layer_;
  FrameType type_;
  std::vector<uint8_t> bytes_;
  std::vector<Tile> tiles_;
};

}  // namespace alhazen::impl
