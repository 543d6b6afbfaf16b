// Reads TGA, after the "Truevision TGA File Format Specification 2.0": palettes, colours of 15 to 32 bits, grey; with
// and without run-length encoding.

#include <algorithm>
#include <utility>
#include <vector>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

struct TgaHeader {
  bool has_palette = false, run_lengths = false, grey = false, indexed = false;
  size_t palette_first = 0, palette_count = 0, palette_bits = 0;
  int width = 0, height = 0;
  size_t bits = 0, alpha_bits = 0;
  bool from_top = false, from_right = false;

  size_t palette_entry_size() const { return (palette_bits + 7) / 8; }
  size_t texel_size() const { return (bits + 7) / 8; }
  size_t colour_bits() const { return indexed ? palette_bits : bits; }
  bool may_have_alpha() const {
    return grey ? bits == 16 : colour_bits() == 32 || (colour_bits() == 16 && alpha_bits == 1);
  }
};

TgaHeader read_tga_header(ByteReader& in) {
  TgaHeader header;
  const size_t id_length = in.u8();
  header.has_palette = in.u8() == 1;
  const int type = in.u8();
  header.run_lengths = (type & 8) != 0;
  header.indexed = (type & ~8) == 1;
  header.grey = (type & ~8) == 3;
  if (type > 11 || (type & ~8) < 1 || (type & ~8) > 3) in.fail("not a TGA image of a known type");
  header.palette_first = in.u16();
  header.palette_count = in.u16();
  header.palette_bits = in.u8();
  in.skip(4);  // the origin on a screen
  header.width = in.u16();
  header.height = in.u16();
  header.bits = in.u8();
  const int descriptor = in.u8();
  header.alpha_bits = static_cast<size_t>(descriptor & 15);
  header.from_right = (descriptor & 0x10) != 0;
  header.from_top = (descriptor & 0x20) != 0;
  in.skip(id_length);
  return header;
}

bool is_colour_depth(size_t bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

void check_header(const TgaHeader& header, const ByteReader& in) {
  const bool depth_is_known =
      header.indexed || header.grey ? header.bits == 8 || header.bits == 16 : is_colour_depth(header.bits);
  if (!depth_is_known) in.fail("a TGA image of " + std::to_string(header.bits) + " bits per texel is not supported");
  if (header.indexed && !header.has_palette) in.fail("a TGA image of indices without a palette");
  if (header.has_palette && !is_colour_depth(header.palette_bits))
    in.fail("a TGA palette of " + std::to_string(header.palette_bits) + " bits per entry is not supported");
}

/// The texels as in the file, `texel_size` bytes each. Runs may extend over the end of a row.
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

/// Blue comes first; 15 and 16 bits have five per channel, and their last bit is not part of the colour.
void decode_colour(const uint8_t* value, size_t bits, uint8_t* rgb) {
  if (bits >= 24) {
    std::reverse_copy(value, value + 3, rgb);
    return;
  }
  const int packed = value[0] | value[1] << 8;
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<uint8_t>(((packed >> (10 - 5 * c) & 31) * 255 + 15) / 31);
}

/// The location of a texel's colour: in the palette, or in the texel itself.
const uint8_t* colour_at(const TgaHeader& header, std::span<const uint8_t> palette, const uint8_t* value,
                         const ByteReader& in) {
  if (!header.indexed) return value;
  const size_t index = header.texel_size() == 1 ? value[0] : static_cast<size_t>(value[0] | value[1] << 8);
  if (index < header.palette_first || index - header.palette_first >= header.palette_count)
    in.fail("a texel has the index " + std::to_string(index) + ", which the palette does not hold");
  return palette.data() + (index - header.palette_first) * header.palette_entry_size();
}

/// In 16-bit grey texels the second byte is alpha.
uint8_t alpha_of(const TgaHeader& header, const uint8_t* colour) {
  if (header.grey) return colour[1];
  return header.colour_bits() == 32 ? colour[3] : static_cast<uint8_t>((colour[1] & 0x80) != 0 ? 255 : 0);
}

/// Calls `store(texel, colour)` with the index of every texel, counted from the top left, and its bytes.
template <class Store>
void read_image(const std::string& path, const TgaHeader& header, ByteReader& in, size_t file_size, ImageTexels& texels,
                const Store& store) {
  check_header(header, in);
  check_size(path, header.width, header.height);
  check_plausible(path,
                  header.texel_size() * static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height),
                  file_size);
  std::span<const uint8_t> palette;
  if (header.has_palette) palette = in.take(header.palette_count * header.palette_entry_size());
  const std::vector<uint8_t> values = read_texels(header, in);
  const size_t width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  texels.bytes.resize(static_cast<size_t>(texels.channels) * width * height);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const size_t row = header.from_top ? y : height - 1 - y, column = header.from_right ? width - 1 - x : x;
      store(row * width + column, colour_at(header, palette, &values[(y * width + x) * header.texel_size()], in));
    }
}

}  // namespace

ImageTexels decode_tga(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const TgaHeader header = read_tga_header(in);
  ImageTexels texels{header.width, header.height, {}, {}, true, path};
  read_image(path, header, in, bytes.size(), texels, [&](size_t texel, const uint8_t* colour) {
    uint8_t* rgb = &texels.bytes[3 * texel];
    if (header.grey)
      std::fill_n(rgb, 3, colour[0]);
    else
      decode_colour(colour, header.colour_bits(), rgb);
  });
  return texels;
}

std::optional<ImageTexels> decode_tga_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const TgaHeader header = read_tga_header(in);
  if (!header.may_have_alpha()) return std::nullopt;
  ImageTexels texels{header.width, header.height, {}, {}, false, path, 1};
  uint8_t any = 0;
  read_image(path, header, in, bytes.size(), texels, [&](size_t texel, const uint8_t* colour) {
    texels.bytes[texel] = alpha_of(header, colour);
    any |= texels.bytes[texel];
  });
  if (any == 0 && header.alpha_bits == 0) return std::nullopt;
  return unless_opaque(std::move(texels));
}

}  // namespace alhazen::impl
