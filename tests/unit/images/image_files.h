#pragma once

// Tiny images in every format, written byte by byte, for the tests of the readers.

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace alhazen::impl::test {

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Bytes text(const std::string& characters) { return {characters.begin(), characters.end()}; }
inline Bytes little_16(uint32_t v) { return {static_cast<uint8_t>(v), static_cast<uint8_t>(v >> 8)}; }
inline Bytes little_32(uint32_t v) { return little_16(v) + little_16(v >> 16); }
inline Bytes big_32(uint32_t v) {
  return {static_cast<uint8_t>(v >> 24), static_cast<uint8_t>(v >> 16), static_cast<uint8_t>(v >> 8),
          static_cast<uint8_t>(v)};
}
inline Bytes floats(std::initializer_list<float> values) {
  Bytes bytes;
  for (const float value : values) bytes = bytes + little_32(std::bit_cast<uint32_t>(value));
  return bytes;
}

inline Bytes png_chunk(const std::string& type, const Bytes& data) {
  const Bytes body = text(type) + data;
  return big_32(static_cast<uint32_t>(data.size())) + body +
         big_32(static_cast<uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))));
}

/// `rows`: each row after its filter byte. `before_data`: chunks between header and data.
/// Colour types: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGB and alpha.
inline Bytes png(uint32_t width, uint32_t height, uint8_t depth, uint8_t colour_type, const Bytes& rows,
                 const Bytes& before_data = {}) {
  Bytes packed(compressBound(rows.size()));
  uLongf size = packed.size();
  compress(packed.data(), &size, rows.data(), rows.size());
  packed.resize(size);
  return Bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'} +
         png_chunk("IHDR", big_32(width) + big_32(height) + Bytes{depth, colour_type, 0, 0, 0}) + before_data +
         png_chunk("IDAT", packed) + png_chunk("IEND", {});
}

/// Descriptor: 0x20 for rows from the top down.
inline Bytes tga(uint8_t type, uint32_t width, uint32_t height, uint8_t bits, uint8_t descriptor, const Bytes& data,
                 const Bytes& palette_fields = {0, 0, 0, 0, 0}, const Bytes& palette = {}) {
  const uint8_t has_palette = palette.empty() ? 0 : 1;
  return Bytes{0, has_palette, type} + palette_fields + Bytes{0, 0, 0, 0} + little_16(width) + little_16(height) +
         Bytes{bits, descriptor} + palette + data;
}

/// With a header of 40 bytes. A negative height: rows from the top down. `behind`: masks or palette.
inline Bytes bmp(int width, int height, uint32_t bits, uint32_t compression, const Bytes& behind, const Bytes& rows,
                 uint32_t colours = 0) {
  const uint32_t texels_at = static_cast<uint32_t>(54 + behind.size());
  return text("BM") + little_32(texels_at + static_cast<uint32_t>(rows.size())) + little_32(0) + little_32(texels_at) +
         little_32(40) + little_32(static_cast<uint32_t>(width)) + little_32(static_cast<uint32_t>(height)) +
         little_16(1) + little_16(bits) + little_32(compression) + little_32(0) + little_32(2835) + little_32(2835) +
         little_32(colours) + little_32(0) + behind + rows;
}

inline Bytes hdr(int width, int height, const Bytes& scanlines) {
  return text("#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
              std::to_string(width) + "\n") +
         scanlines;
}

inline Bytes pfm(const std::string& kind, int width, int height, const std::string& scale, const Bytes& values) {
  return text(kind + "\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + scale + "\n") + values;
}

/// One block of 8 x 8 pixels of one colour. The only quantizer is 8, so that a coefficient of 40 is a value of 128 +
/// 40; the only DC code, 0, is followed by 6 bits; the only AC code, 0, ends a block.
/// `components`: 1 (grey of 168) or 3 (Y, Cb and Cr of 168, 168 and 88).
inline Bytes jpeg(uint8_t components) {
  Bytes quantisers(64, 8);
  Bytes frame{8, 0, 8, 0, 8, components}, scan{components};
  for (uint8_t c = 1; c <= components; ++c) {
    frame = frame + Bytes{c, 0x11, 0};
    scan = scan + Bytes{c, 0};
  }
  Bytes one_code(16, 0);
  one_code[0] = 1;
  const auto segment = [](uint8_t marker, const Bytes& data) {
    return Bytes{0xff, marker, 0, static_cast<uint8_t>(data.size() + 2)} + data;
  };
  // 0 101000 0 is 40, 0 010111 0 is -40.
  const Bytes data = components == 1 ? Bytes{0x50} : Bytes{0x50, 0x50, 0x2e};
  return Bytes{0xff, 0xd8} + segment(0xdb, Bytes{0} + quantisers) + segment(0xc0, frame) +
         segment(0xc4, Bytes{0x00} + one_code + Bytes{6}) + segment(0xc4, Bytes{0x10} + one_code + Bytes{0}) +
         segment(0xda, scan + Bytes{0, 63, 0}) + data + Bytes{0xff, 0xd9};
}

}  // namespace alhazen::impl::test
