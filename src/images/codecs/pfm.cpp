// Reads PFM: "PF" (colour) or "Pf" (grey), width, height, scale, then floats, rows from the bottom up. A negative scale
// scale means little-endian; its absolute value is a factor on the values.

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

namespace alhazen {

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

}  // namespace alhazen
