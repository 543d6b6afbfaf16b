// Reads BMP: the uncompressed variants of all header versions, with palettes and bit masks.

#include <array>
#include <bit>
#include <cstdlib>
#include <utility>
#include <vector>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

struct BmpHeader {
  size_t texels_at = 0;  ///< from the start of the file
  int64_t width = 0, height = 0;
  bool from_top = false;
  size_t bits = 0;
  size_t palette_at = 0, palette_count = 0, palette_entry_size = 4;
  std::array<uint32_t, 4> masks{};  ///< red, green, blue, alpha; for 16 and 32 bits
  bool alpha_is_declared = false;

  /// Rows are padded to four bytes.
  size_t row_size() const { return (static_cast<size_t>(width) * bits + 31) / 32 * 4; }
};

/// The oldest header, of 12 bytes, has small numbers and palette entries of three bytes.
void read_core_header(ByteReader& in, BmpHeader& header) {
  header.width = in.u16();
  header.height = in.u16();
  in.skip(2);  // planes
  header.bits = in.u16();
  header.palette_entry_size = 3;
}

void read_info_header(ByteReader& in, size_t header_size, BmpHeader& header) {
  header.width = in.i32();
  const int64_t height = in.i32();
  header.from_top = height < 0;
  header.height = std::abs(height);
  in.skip(2);  // planes
  header.bits = in.u16();
  const uint32_t compression = in.u32();
  const bool has_masks = compression == 3 || compression == 6;
  if (compression != 0 && !has_masks) in.fail("a compressed BMP image is not supported; save it without compression");
  in.skip(12);  // size of the texels, resolution
  header.palette_count = in.u32();
  in.skip(4);  // important colours
  const bool has_alpha_mask = has_masks && (header_size >= 56 || compression == 6);
  if (has_masks)
    for (size_t c = 0; c < (has_alpha_mask ? 4u : 3u); ++c) header.masks[c] = in.u32();
  header.alpha_is_declared = header.masks[3] != 0;
  // The masks follow a header of 40 bytes.
  header.palette_at = 14 + header_size + (has_masks && header_size == 40 ? (compression == 6 ? 16 : 12) : 0);
  if (!has_masks && header.bits == 16) header.masks = {0x7c00, 0x03e0, 0x001f, 0};
  if (!has_masks && header.bits == 32) header.masks = {0xff0000, 0x00ff00, 0x0000ff, 0xff000000};
}

BmpHeader read_bmp_header(ByteReader& in) {
  BmpHeader header;
  in.skip(10);
  header.texels_at = in.u32();
  const size_t header_size = in.u32();
  if (header_size != 12 && (header_size < 40 || header_size > 124)) in.fail("not a BMP image of a known version");
  header.palette_at = 14 + header_size;
  if (header_size == 12)
    read_core_header(in, header);
  else
    read_info_header(in, header_size, header);
  const bool indexed = header.bits == 1 || header.bits == 4 || header.bits == 8;
  if (!indexed && header.bits != 16 && header.bits != 24 && header.bits != 32)
    in.fail("a BMP image of " + std::to_string(header.bits) + " bits per texel is not supported");
  const size_t full_palette = size_t{1} << (indexed ? header.bits : 0);
  if (indexed && (header.palette_count == 0 || header.palette_count > full_palette))
    header.palette_count = full_palette;
  return header;
}

/// One texel of 16 or 32 bits.
uint32_t packed_texel(const BmpHeader& header, std::span<const uint8_t> row, size_t x) {
  uint32_t value = 0;
  for (size_t i = header.bits / 8; i-- > 0;) value = value << 8 | row[x * header.bits / 8 + i];
  return value;
}

/// The bits of `value` under `mask`, scaled to eight.
uint8_t masked(uint32_t value, uint32_t mask) {
  if (mask == 0) return 0;
  const int shift = std::countr_zero(mask);
  const uint64_t max_value = mask >> shift;
  return static_cast<uint8_t>(((value & mask) >> shift) * uint64_t{255} / max_value);
}

void decode_row(const BmpHeader& header, std::span<const uint8_t> palette, std::span<const uint8_t> row, uint8_t* rgb,
                const ByteReader& in) {
  for (size_t x = 0; x < static_cast<size_t>(header.width); ++x, rgb += 3) {
    if (header.bits <= 8) {
      const size_t first_bit = x * header.bits, shift = 8 - header.bits - first_bit % 8;
      const size_t index = static_cast<size_t>(row[first_bit / 8] >> shift) & ((size_t{1} << header.bits) - 1);
      if (index >= header.palette_count) in.fail("a texel has an index that the palette does not hold");
      for (size_t c = 0; c < 3; ++c) rgb[c] = palette[index * header.palette_entry_size + 2 - c];
    } else if (header.bits == 24) {
      for (size_t c = 0; c < 3; ++c) rgb[c] = row[3 * x + 2 - c];
    } else {
      const uint32_t value = packed_texel(header, row, x);
      for (size_t c = 0; c < 3; ++c) rgb[c] = masked(value, header.masks[c]);
    }
  }
}

/// The row that is stored `y` rows from the start of the texels.
size_t row_from_top(const BmpHeader& header, size_t y) {
  return header.from_top ? y : static_cast<size_t>(header.height) - 1 - y;
}

}  // namespace

ImageTexels decode_bmp(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const BmpHeader header = read_bmp_header(in);
  check_size(path, header.width, header.height);
  std::span<const uint8_t> palette;
  if (header.bits <= 8) {
    in.seek(header.palette_at);
    palette = in.take(header.palette_count * header.palette_entry_size);
  }
  in.seek(header.texels_at);
  const std::span<const uint8_t> rows = in.take(header.row_size() * static_cast<size_t>(header.height));

  ImageTexels texels{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}, true, path};
  const size_t width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  texels.bytes.resize(3 * width * height);
  for (size_t y = 0; y < height; ++y) {
    const size_t row = row_from_top(header, y);
    decode_row(header, palette, rows.subspan(y * header.row_size(), header.row_size()), &texels.bytes[3 * row * width],
               in);
  }
  return texels;
}

std::optional<ImageTexels> decode_bmp_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const BmpHeader header = read_bmp_header(in);
  if ((header.bits != 16 && header.bits != 32) || header.masks[3] == 0) return std::nullopt;
  check_size(path, header.width, header.height);
  in.seek(header.texels_at);
  const std::span<const uint8_t> rows = in.take(header.row_size() * static_cast<size_t>(header.height));
  ImageTexels texels{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}, false, path, 1};
  const size_t width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  texels.bytes.resize(width * height);
  uint8_t any = 0;
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const uint32_t value = packed_texel(header, rows.subspan(y * header.row_size(), header.row_size()), x);
      uint8_t& alpha = texels.bytes[row_from_top(header, y) * width + x];
      alpha = masked(value, header.masks[3]);
      any |= alpha;
    }
  if (any == 0 && !header.alpha_is_declared) return std::nullopt;
  return unless_opaque(std::move(texels));
}

}  // namespace alhazen::impl
