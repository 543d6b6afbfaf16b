// Reads and writes PFM: "PF" (colour) or "Pf" (grey), width, height, scale, then floats, rows from the bottom up. A
// negative scale means little-endian; its absolute value is a factor on the values (Debevec, "PFM Portable FloatMap
// Image Format").

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include "files/atomic_file.h"
#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

bool is_space(uint8_t c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// The next word of the header; the single space after it is consumed.
std::string read_word(ByteReader& in) {
  uint8_t c = in.u8();
  while (is_space(c)) c = in.u8();
  std::string word;
  for (; !is_space(c) && word.size() < 32; c = in.u8()) word += static_cast<char>(c);
  return word;
}

template <class Number>
Number read_number(ByteReader& in, const char* what) {
  const std::string word = read_word(in);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    in.fail(std::string("the ") + what + " of the PFM image is not a number");
  return value;
}

float read_float(const uint8_t* bytes, bool little_endian) {
  std::array<uint8_t, 4> native{bytes[0], bytes[1], bytes[2], bytes[3]};
  if (little_endian != (std::endian::native == std::endian::little)) native = {bytes[3], bytes[2], bytes[1], bytes[0]};
  return std::bit_cast<float>(native);
}

void store_little_endian(float value, uint8_t* bytes) {
  const auto bits = std::bit_cast<uint32_t>(value);
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<uint8_t>(bits >> 8 * i);
}

}  // namespace

ImageTexels decode_pfm(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  const size_t channels = read_word(in) == "PF" ? 3 : 1;
  const int64_t columns = read_number<int64_t>(in, "width"), rows = read_number<int64_t>(in, "height");
  const double scale = read_number<double>(in, "scale");
  if (scale == 0 || !std::isfinite(scale)) in.fail("the scale of the PFM image is not a finite number other than 0");
  check_size(path, columns, rows);

  const size_t width = static_cast<size_t>(columns), height = static_cast<size_t>(rows);
  const std::span<const uint8_t> values = in.take(width * height * channels * 4);
  const float factor = static_cast<float>(std::abs(scale));
  ImageTexels texels{static_cast<int>(columns), static_cast<int>(rows), {}, {}, false, path};
  texels.floats.resize(3 * width * height);
  for (size_t y = 0; y < height; ++y)
    for (size_t i = 0; i < 3 * width; ++i) {
      const size_t value = (height - 1 - y) * width * channels + (channels == 3 ? i : i / 3);
      texels.floats[y * 3 * width + i] = factor * read_float(values.data() + 4 * value, scale < 0);
    }
  return texels;
}

/// Writes colour with a scale of -1. Bits of values are kept, also of those that are infinite or not a number.
void write_pfm(const std::string& path, const ImageSource& source, const WriteOptions&) {
  const std::array<size_t, 3> channels = rgb_channels(path, source);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint8_t> bytes(3 * width * sizeof(float));
  AtomicFile file(path);
  const std::string header = "PF\n" + std::to_string(source.width) + " " + std::to_string(source.height) + "\n-1.0\n";
  file.write(header.data(), header.size());
  for (int y = source.height - 1; y >= 0; --y) {
    source.fill_row(y, row);
    for (size_t x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c)
        store_little_endian(row[channels[c] * width + x], &bytes[(3 * x + c) * sizeof(float)]);
    file.write(bytes.data(), bytes.size());
  }
  file.commit();
}

}  // namespace alhazen::impl
