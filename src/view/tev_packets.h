#pragma once

// Packets of the protocol by which other programs show images in tev (https://github.com/Tom94/tev): the whole length
// in bytes, the kind, and what follows for that kind. Numbers are little endian, texts end with a zero byte.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::impl {

/// Kinds that are sent here.
enum class TevPacketKind : uint8_t { create_image = 4, update_image = 6 };

/// Bytes to send one after another: the head, then the parts, which belong to the image.
struct TevPacket {
  std::vector<char> head;
  std::vector<std::span<const float>> parts;

  size_t size() const;
};

/// Makes an image with black pixels and selects it; it replaces one of the same name.
TevPacket tev_create_image(const std::string& name, const Image& image);

/// Rows y0 <= y < y1 of all channels.
TevPacket tev_update_image(const std::string& name, const Image& image, int y0, int y1);

/// How many rows a packet should have. tev begins with a buffer of 1 MiB for each connection, and makes it larger for
/// packets that need it.
int tev_rows_per_packet(const Image& image);

}  // namespace alhazen::impl
