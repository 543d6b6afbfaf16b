// Reads Radiance HDR (RGBE), after Ward, "Real Pixels", Graphics Gems II, and the format's manual page: flat scanlines,
// the old run-length encoding and the new one. Values are used unchanged: EXPOSURE lines are ignored, as in other
// renderers.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

using Rgbe = std::array<uint8_t, 4>;

void read_variables(ByteReader& in) {
  in.line();  // "#?RADIANCE" or "#?RGBE"
  for (std::string_view line = in.line(); !line.empty() && line != "\r"; line = in.line())
    if (line.starts_with("FORMAT=") && !line.starts_with("FORMAT=32-bit_rle_rgbe"))
      in.fail("an HDR image with " + std::string(line.substr(0, 40)) + "; only 32-bit_rle_rgbe is supported");
}

/// How the scanlines of a file form the image. "-Y height +X width" means rows from the top down, each from the left;
/// -X runs from the right, +Y from the bottom up, and if X comes first the scanlines are columns.
struct Layout {
  int64_t width = 0, height = 0;
  bool from_bottom = false, from_right = false, columns = false;

  int64_t scanlines() const { return columns ? width : height; }
  int64_t scanline_length() const { return columns ? height : width; }

  /// Index, counted from the top left, of texel `i` of scanline `line`.
  size_t texel(int64_t line, int64_t i) const {
    const int64_t x = columns ? line : i, y = columns ? i : line;
    return static_cast<size_t>((from_bottom ? height - 1 - y : y) * width + (from_right ? width - 1 - x : x));
  }
};

/// Reads one axis, " -Y 32" with or without blanks before it, and removes it from `line`.
bool read_axis(std::string_view& line, char& name, bool& negative, int64_t& size) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (line.size() < 3 || (line[0] != '-' && line[0] != '+') || (line[1] != 'X' && line[1] != 'Y')) return false;
  negative = line[0] == '-';
  name = line[1];
  line.remove_prefix(2);
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), size);
  line.remove_prefix(static_cast<size_t>(end - line.data()));
  return error == std::errc();
}

Layout read_layout(ByteReader& in) {
  std::string_view line = in.line();
  char first = 0, second = 0;
  bool first_negative = false, second_negative = false;
  int64_t first_size = 0, second_size = 0;
  if (!read_axis(line, first, first_negative, first_size) || !read_axis(line, second, second_negative, second_size) ||
      first == second)
    in.fail("an HDR image whose size is not given as \"-Y height +X width\" or another order of the axes");
  Layout layout;
  layout.columns = first == 'X';
  layout.width = layout.columns ? first_size : second_size;
  layout.height = layout.columns ? second_size : first_size;
  layout.from_right = layout.columns ? first_negative : second_negative;
  layout.from_bottom = layout.columns ? !second_negative : !first_negative;
  return layout;
}

/// Decodes each of the four components separately: runs (128 + count, value) and literals (count, values).
void read_new_run_lengths(ByteReader& in, std::vector<Rgbe>& row) {
  for (size_t component = 0; component < 4; ++component) {
    size_t x = 0;
    while (x < row.size()) {
      const size_t code = in.u8();
      const bool run = code > 128;
      const size_t count = run ? code - 128 : code;
      if (count == 0 || count > row.size() - x) in.fail("a run of the HDR image extends past its row; it is damaged");
      const std::span<const uint8_t> values = in.take(run ? 1 : count);
      for (size_t i = 0; i < count; ++i) row[x++][component] = values[run ? 0 : i];
    }
  }
}

/// Decodes texels in order; (1, 1, 1, n) repeats the previous one n times, and n * 256 times if it follows another such
/// code. `first` is the part of the row that has been read already.
void read_old_run_lengths(ByteReader& in, const Rgbe& first, std::vector<Rgbe>& row) {
  Rgbe texel = first;
  size_t x = 0;
  int shift = 0;
  while (true) {
    if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
      const size_t count = size_t{texel[3]} << shift;
      if (x == 0 || shift > 16 || count > row.size() - x)
        in.fail("a run of the HDR image extends past its row; it is damaged");
      const Rgbe last = row[x - 1];
      for (size_t i = 0; i < count; ++i) row[x++] = last;
      shift += 8;
    } else {
      row[x++] = texel;
      shift = 0;
    }
    if (x == row.size()) return;
    const auto next = in.take(4);
    texel = {next[0], next[1], next[2], next[3]};
  }
}

void read_row(ByteReader& in, std::vector<Rgbe>& row) {
  const auto head = in.take(4);
  const size_t declared = static_cast<size_t>(head[2]) << 8 | head[3];
  if (head[0] == 2 && head[1] == 2 && declared == row.size() && row.size() >= 8 && row.size() < 32768)
    read_new_run_lengths(in, row);
  else
    read_old_run_lengths(in, {head[0], head[1], head[2], head[3]}, row);
}

/// Mantissas of 8 bits with a common exponent, biased by 128.
void decode_texel(const Rgbe& texel, float* rgb) {
  const float unit = texel[3] == 0 ? 0.0f : std::ldexp(1.0f, texel[3] - (128 + 8));
  for (size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(texel[c]) * unit;
}

}  // namespace

ImageTexels decode_hdr(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  read_variables(in);
  const Layout layout = read_layout(in);
  check_size(path, layout.width, layout.height);
  check_plausible(path, sizeof(Rgbe) * static_cast<uint64_t>(layout.width * layout.height), bytes.size());

  ImageTexels texels{static_cast<int>(layout.width), static_cast<int>(layout.height), {}, {}, false, path};
  texels.floats.resize(static_cast<size_t>(3 * layout.width * layout.height));
  std::vector<Rgbe> scanline(static_cast<size_t>(layout.scanline_length()));
  for (int64_t line = 0; line < layout.scanlines(); ++line) {
    read_row(in, scanline);
    for (size_t i = 0; i < scanline.size(); ++i)
      decode_texel(scanline[i], &texels.floats[3 * layout.texel(line, static_cast<int64_t>(i))]);
  }
  return texels;
}

}  // namespace alhazen::impl
