// Radiance HDR input (RGBE), after Ward, "Real Pixels", Graphics Gems II, and the format's manual page: flat scanlines,
// the old run lengths and the new ones. Values are taken as they stand: EXPOSURE lines are not divided out, as other
// renderers do not.

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "io/images/byte_reader.h"
#include "io/images/decoders.h"

namespace alhazen {

namespace {

using Rgbe = std::array<uint8_t, 4>;

void read_variables(ByteReader& in) {
  in.line();  // "#?RADIANCE" or "#?RGBE"
  for (std::string_view line = in.line(); !line.empty() && line != "\r"; line = in.line())
    if (line.starts_with("FORMAT=") && !line.starts_with("FORMAT=32-bit_rle_rgbe"))
      in.fail("an HDR picture with " + std::string(line.substr(0, 40)) + "; only 32-bit_rle_rgbe is supported");
}

/// "-Y height +X width": rows from the top down, columns from the left. The other seven orders hardly exist.
void read_size(ByteReader& in, int64_t& width, int64_t& height) {
  const std::string_view line = in.line();
  const auto number = [&](std::string_view axis, int64_t& value) {
    const size_t start = line.find(axis);
    if (start == std::string_view::npos) return false;
    const char* first = line.data() + start + axis.size();
    return std::from_chars(first, line.data() + line.size(), value).ec == std::errc();
  };
  if (!line.starts_with("-Y ") || !number("-Y ", height) || !number(" +X ", width))
    in.fail("an HDR picture whose size is not given as \"-Y height +X width\"");
}

/// Each of the four components by itself: runs (128 + count, value) and literals (count, values).
void read_new_run_lengths(ByteReader& in, std::vector<Rgbe>& row) {
  for (size_t component = 0; component < 4; ++component) {
    size_t x = 0;
    while (x < row.size()) {
      const size_t code = in.u8();
      const bool run = code > 128;
      const size_t count = run ? code - 128 : code;
      if (count == 0 || count > row.size() - x) in.fail("a run of the HDR picture leaves its row; it is damaged");
      const std::span<const uint8_t> values = in.take(run ? 1 : count);
      for (size_t i = 0; i < count; ++i) row[x++][component] = values[run ? 0 : i];
    }
  }
}

/// Texels one after the other; (1, 1, 1, n) repeats the last one n times, and again n * 256 times where it follows
/// itself. `first` is what has been read of the row already.
void read_old_run_lengths(ByteReader& in, const Rgbe& first, std::vector<Rgbe>& row) {
  Rgbe texel = first;
  size_t x = 0;
  int shift = 0;
  while (true) {
    if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
      const size_t count = size_t{texel[3]} << shift;
      if (x == 0 || shift > 16 || count > row.size() - x)
        in.fail("a run of the HDR picture leaves its row; it is damaged");
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

/// Mantissas of 8 bits below a common exponent, biased by 128.
void decode_texel(const Rgbe& texel, float* rgb) {
  const float unit = texel[3] == 0 ? 0.0f : std::ldexp(1.0f, texel[3] - (128 + 8));
  for (size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(texel[c]) * unit;
}

}  // namespace

ImageTexels decode_hdr(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  int64_t width = 0, height = 0;
  read_variables(in);
  read_size(in, width, height);
  check_size(path, width, height);
  check_plausible(path, sizeof(Rgbe) * static_cast<uint64_t>(width * height), bytes.size());

  ImageTexels texels{static_cast<int>(width), static_cast<int>(height), {}, {}, false, path};
  texels.floats.resize(static_cast<size_t>(3 * width * height));
  std::vector<Rgbe> row(static_cast<size_t>(width));
  float* rgb = texels.floats.data();
  for (int64_t y = 0; y < height; ++y) {
    read_row(in, row);
    for (const Rgbe& texel : row) {
      decode_texel(texel, rgb);
      rgb += 3;
    }
  }
  return texels;
}

}  // namespace alhazen
