// TGA input, after the "Truevision TGA File Format Specification 2.0": palettes, colours of 15 to 32 bits, grey; with
// and without run lengths.

#include <algorithm>
#include <vector>

#include "io/images/byte_reader.h"
#include "io/images/decoders.h"

namespace alhazen {

namespace {

struct TgaHeader {
  bool has_palette = false, run_lengths = false, grey = false, indexed = false;
  size_t palette_first = 0, palette_count = 0, palette_bits = 0;
  int width = 0, height = 0;
  size_t bits = 0;
  bool from_top = false, from_right = false;

  size_t palette_entry_size() const { return (palette_bits + 7) / 8; }
  size_t texel_size() const { return (bits + 7) / 8; }
};

TgaHeader read_header(ByteReader& in) {
  TgaHeader header;
  const size_t id_length = in.u8();
  header.has_palette = in.u8() == 1;
  const int type = in.u8();
  header.run_lengths = (type & 8) != 0;
  header.indexed = (type & ~8) == 1;
  header.grey = (type & ~8) == 3;
  if (type > 11 || (type & ~8) < 1 || (type & ~8) > 3) in.fail("not a TGA picture of a known type");
  header.palette_first = in.u16();
  header.palette_count = in.u16();
  header.palette_bits = in.u8();
  in.skip(4);  // the origin on a screen
  header.width = in.u16();
  header.height = in.u16();
  header.bits = in.u8();
  const int descriptor = in.u8();
  header.from_right = (descriptor & 0x10) != 0;
  header.from_top = (descriptor & 0x20) != 0;
  in.skip(id_length);
  return header;
}

bool is_colour_depth(size_t bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

void check_header(const TgaHeader& header, const ByteReader& in) {
  const bool depth_is_known =
      header.indexed || header.grey ? header.bits == 8 || header.bits == 16 : is_colour_depth(header.bits);
  if (!depth_is_known) in.fail("a TGA picture of " + std::to_string(header.bits) + " bits a texel is not supported");
  if (header.indexed && !header.has_palette) in.fail("a TGA picture of indices without a palette");
  if (header.has_palette && !is_colour_depth(header.palette_bits))
    in.fail("a TGA palette of " + std::to_string(header.palette_bits) + " bits an entry is not supported");
}

/// The texels as the file has them, `texel_size` bytes each. Runs may go on over the end of a row.
std::vector<uint8_t> read_texels(const TgaHeader& header, ByteReader& in) {
  const size_t size = header.texel_size();
  std::vector<uint8_t> texels(static_cast<size_t>(header.width) * static_cast<size_t>(header.height) * size);
  size_t done = 0;
  while (done < texels.size()) {
    const bool packed = header.run_lengths;
    const int packet = packed ? in.u8() : 0;
    const size_t count = packed ? static_cast<size_t>(packet & 127) + 1 : texels.size() / size;
    const size_t length = std::min(count * size, texels.size() - done);
    const std::span<const uint8_t> values = in.take((packet & 128) != 0 ? size : length);
    for (size_t i = 0; i < length; ++i) texels[done + i] = values[i % values.size()];
    done += length;
  }
  return texels;
}

/// Blue stands first; 15 and 16 bits have five a channel, and their last bit is no colour.
void decode_colour(const uint8_t* value, size_t bits, uint8_t* rgb) {
  if (bits >= 24) {
    std::reverse_copy(value, value + 3, rgb);
    return;
  }
  const int packed = value[0] | value[1] << 8;
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<uint8_t>(((packed >> (10 - 5 * c) & 31) * 255 + 15) / 31);
}

void decode_texel(const TgaHeader& header, std::span<const uint8_t> palette, const uint8_t* value, uint8_t* rgb,
                  const ByteReader& in) {
  if (header.grey) {  // of 16 bits, the second eight are alpha
    std::fill_n(rgb, 3, value[0]);
    return;
  }
  if (!header.indexed) return decode_colour(value, header.bits, rgb);
  const size_t index = header.texel_size() == 1 ? value[0] : static_cast<size_t>(value[0] | value[1] << 8);
  if (index < header.palette_first || index - header.palette_first >= header.palette_count)
    in.fail("a texel has the index " + std::to_string(index) + ", which the palette does not hold");
  const size_t offset = (index - header.palette_first) * header.palette_entry_size();
  decode_colour(palette.data() + offset, header.palette_bits, rgb);
}

}  // namespace

ImageTexels decode_tga(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const TgaHeader header = read_header(in);
  check_header(header, in);
  check_size(path, header.width, header.height);
  check_plausible(path,
                  header.texel_size() * static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height),
                  bytes.size());
  std::span<const uint8_t> palette;
  if (header.has_palette) palette = in.take(header.palette_count * header.palette_entry_size());
  const std::vector<uint8_t> values = read_texels(header, in);

  ImageTexels texels{header.width, header.height, {}, {}, true, path};
  const size_t width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  texels.bytes.resize(3 * width * height);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const size_t row = header.from_top ? y : height - 1 - y, column = header.from_right ? width - 1 - x : x;
      decode_texel(header, palette, &values[(y * width + x) * header.texel_size()],
                   &texels.bytes[3 * (row * width + column)], in);
    }
  return texels;
}

}  // namespace alhazen
