// Reads QOI, after "The Quite OK Image Format, Specification Version 1.0" (2022): lossless 8-bit RGB and RGBA.

#include <algorithm>
#include <array>
#include <utility>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

using Pixel = std::array<uint8_t, 4>;

uint32_t big_endian_32(ByteReader& in) {
  const auto b = in.take(4);
  return static_cast<uint32_t>(b[0]) << 24 | static_cast<uint32_t>(b[1]) << 16 | static_cast<uint32_t>(b[2]) << 8 |
         b[3];
}

struct QoiHeader {
  int64_t width = 0, height = 0;
  bool has_alpha = false, linear = false;
};

QoiHeader read_qoi_header(ByteReader& in) {
  in.skip(4);  // the signature
  QoiHeader header;
  header.width = big_endian_32(in);
  header.height = big_endian_32(in);
  const int channels = in.u8(), colour_space = in.u8();
  if (channels != 3 && channels != 4)
    in.fail("a QOI image of " + std::to_string(channels) + " channels; it has 3 or 4");
  if (colour_space > 1) in.fail("a QOI image of an unknown colour space");
  header.has_alpha = channels == 4;
  header.linear = colour_space == 1;
  return header;
}

uint8_t sum(uint8_t value, int difference) { return static_cast<uint8_t>(value + difference); }

/// Reads one chunk, which changes `pixel`, and returns the number of pixels that it encodes.
int64_t read_chunk(ByteReader& in, const std::array<Pixel, 64>& seen, Pixel& pixel) {
  const int tag = in.u8();
  if (tag >= 0xfe) {  // the values themselves, without and with alpha
    const auto values = in.take(tag == 0xff ? 4 : 3);
    std::copy(values.begin(), values.end(), pixel.begin());
    return 1;
  }
  const int low = tag & 63;
  switch (tag >> 6) {
    case 0:  // a pixel that was seen before
      pixel = seen[static_cast<size_t>(low)];
      return 1;
    case 1:  // small differences from the last pixel
      pixel = {sum(pixel[0], (low >> 4) - 2), sum(pixel[1], (low >> 2 & 3) - 2), sum(pixel[2], (low & 3) - 2),
               pixel[3]};
      return 1;
    case 2: {  // a difference of green, and those of red and blue from it
      const int next = in.u8(), green = low - 32;
      pixel = {sum(pixel[0], green - 8 + (next >> 4)), sum(pixel[1], green), sum(pixel[2], green - 8 + (next & 15)),
               pixel[3]};
      return 1;
    }
    default:  // a run of the last pixel
      return low + 1;
  }
}

/// Calls `store(index, pixel)` for every pixel, rows from the top down.
template <class Store>
void decode_pixels(ByteReader& in, size_t count, const Store& store) {
  std::array<Pixel, 64> seen{};
  Pixel pixel{0, 0, 0, 255};
  for (size_t i = 0; i < count;) {
    const int64_t run = read_chunk(in, seen, pixel);
    seen[static_cast<size_t>(pixel[0] * 3 + pixel[1] * 5 + pixel[2] * 7 + pixel[3] * 11) % 64] = pixel;
    for (int64_t k = 0; k < run && i < count; ++k) store(i++, pixel);
  }
  const auto end = in.take(8);
  if (end[0] != 0 || end[6] != 0 || end[7] != 1) in.fail("the QOI image does not end where it should; it is damaged");
}

ImageTexels empty_texels(const std::string& path, const QoiHeader& header, size_t file_size, int channels) {
  check_size(path, header.width, header.height);
  const size_t count = static_cast<size_t>(header.width) * static_cast<size_t>(header.height);
  check_plausible(path, count, file_size);
  ImageTexels texels{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}, false, path, channels};
  texels.bytes.resize(count * static_cast<size_t>(channels));
  return texels;
}

}  // namespace

ImageTexels decode_qoi(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const QoiHeader header = read_qoi_header(in);
  ImageTexels texels = empty_texels(path, header, bytes.size(), 3);
  texels.srgb = !header.linear;
  decode_pixels(in, texels.bytes.size() / 3, [&](size_t i, const Pixel& pixel) {
    for (size_t c = 0; c < 3; ++c) texels.bytes[3 * i + c] = pixel[c];
  });
  return texels;
}

std::optional<ImageTexels> decode_qoi_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const QoiHeader header = read_qoi_header(in);
  if (!header.has_alpha) return std::nullopt;
  ImageTexels texels = empty_texels(path, header, bytes.size(), 1);
  decode_pixels(in, texels.bytes.size(), [&](size_t i, const Pixel& pixel) { texels.bytes[i] = pixel[3]; });
  return unless_opaque(std::move(texels));
}

}  // namespace alhazen::impl
