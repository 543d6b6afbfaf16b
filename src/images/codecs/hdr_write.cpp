// Writes Radiance HDR (RGBE), after Ward, "Real Pixels", Graphics Gems II, and the format's manual page: rows from the
// top down, each component of a row run-length encoded by itself.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "files/atomic_file.h"
#include "images/image.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

/// Mantissas of 8 bits with the exponent of the largest, biased by 128, which is rounded to nearest: the reader, and
/// that of most programs, takes mantissas as they are, without half a step.
std::array<uint8_t, 4> to_rgbe(const std::array<float, 3>& rgb) {
  constexpr double largest = 0x1.fep126;  // 255 with the exponent 127
  std::array<double, 3> values;
  for (size_t c = 0; c < 3; ++c) values[c] = rgb[c] > 0 ? std::min(static_cast<double>(rgb[c]), largest) : 0;
  const double brightest = *std::max_element(values.begin(), values.end());
  if (!(brightest > 0)) return {};
  int exponent = std::ilogb(brightest) + 1;
  if (std::round(std::ldexp(brightest, 8 - exponent)) > 255) ++exponent;
  if (exponent < -127) return {};
  std::array<uint8_t, 4> texel{0, 0, 0, static_cast<uint8_t>(exponent + 128)};
  for (size_t c = 0; c < 3; ++c) texel[c] = static_cast<uint8_t>(std::round(std::ldexp(values[c], 8 - exponent)));
  return texel;
}

constexpr size_t shortest_run = 4;

size_t run_at(const std::vector<uint8_t>& values, size_t begin) {
  size_t end = begin + 1;
  while (end < values.size() && end - begin < 127 && values[end] == values[begin]) ++end;
  return end - begin;
}

/// Runs as (128 + count, value), and literals as (count, values).
void append_run_lengths(const std::vector<uint8_t>& values, std::vector<uint8_t>& bytes) {
  for (size_t at = 0; at < values.size();) {
    const size_t run = run_at(values, at);
    if (run >= shortest_run) {
      bytes.insert(bytes.end(), {static_cast<uint8_t>(128 + run), values[at]});
      at += run;
      continue;
    }
    size_t end = at;
    while (end < values.size() && end - at < 128 && run_at(values, end) < shortest_run) ++end;
    bytes.push_back(static_cast<uint8_t>(end - at));
    bytes.insert(bytes.end(), values.begin() + static_cast<std::ptrdiff_t>(at),
                 values.begin() + static_cast<std::ptrdiff_t>(end));
    at = end;
  }
}

std::string hdr_header(const ImageSource& source, const WriteOptions& options) {
  std::string header = "#?RADIANCE\n";
  if (const auto software = options.metadata.find("software"); software != options.metadata.end())
    header += "SOFTWARE=" + printable(software->second) + "\n";
  return header +
         "FORMAT=32-bit_rle_rgbe\n"
         "PRIMARIES=0.6400 0.3300 0.3000 0.6000 0.1500 0.0600 0.3127 0.3290\n\n"
         "-Y " +
         std::to_string(source.height) + " +X " + std::to_string(source.width) + "\n";
}

}  // namespace

void write_hdr(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  const std::array<size_t, 3> channels = rgb_channels(path, source);
  const size_t width = static_cast<size_t>(source.width);
  // The encoding holds rows of these lengths; others are stored plainly.
  const bool is_encoded = width >= 8 && width < 32768;
  std::vector<float> row(source.channels.size() * width);
  std::array<std::vector<uint8_t>, 4> components;
  for (std::vector<uint8_t>& component : components) component.resize(width);
  std::vector<uint8_t> bytes;
  AtomicFile file(path);
  const std::string header = hdr_header(source, options);
  file.write(header.data(), header.size());
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    bytes.clear();
    for (size_t x = 0; x < width; ++x) {
      const auto value = [&](size_t c) { return row[channels[c] * width + x]; };
      const std::array<uint8_t, 4> texel = to_rgbe({value(0), value(1), value(2)});
      for (size_t c = 0; c < 4; ++c) components[c][x] = texel[c];
      if (!is_encoded) bytes.insert(bytes.end(), texel.begin(), texel.end());
    }
    if (is_encoded) {
      bytes = {2, 2, static_cast<uint8_t>(width >> 8), static_cast<uint8_t>(width)};
      for (const std::vector<uint8_t>& component : components) append_run_lengths(component, bytes);
    }
    file.write(bytes.data(), bytes.size());
  }
  file.commit();
}

}  // namespace alhazen::impl
