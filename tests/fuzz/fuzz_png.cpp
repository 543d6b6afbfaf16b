// Reads colours and alpha of any bytes as a PNG file: gives as many texels as declared, or an InputError.

#include <zlib.h>

#include <vector>

#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"

namespace {

uint32_t big_endian(const uint8_t* bytes) {
  return static_cast<uint32_t>(bytes[0]) << 24 | static_cast<uint32_t>(bytes[1]) << 16 |
         static_cast<uint32_t>(bytes[2]) << 8 | bytes[3];
}

/// Corrects the checksum of every chunk; otherwise nearly all inputs of a fuzzer are refused for their checksums.
std::vector<uint8_t> with_right_checksums(std::vector<uint8_t> file) {
  constexpr size_t signature = 8, around = 12;  // length and type before the data of a chunk, checksum after it
  for (size_t at = signature; at + around <= file.size();) {
    const size_t length = big_endian(&file[at]);
    if (length > file.size() - at - around) break;
    const auto checksum = static_cast<uint32_t>(crc32(0, &file[at + 4], static_cast<uInt>(length + 4)));
    for (size_t i = 0; i < 4; ++i) file[at + 8 + length + i] = static_cast<uint8_t>(checksum >> (24 - 8 * i));
    at += around + length;
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  std::vector<uint8_t> bytes(data, data + size);
  // The last byte, which is part of a checksum in a whole file, selects the option.
  if (size > 0 && data[size - 1] % 4 != 0) bytes = with_right_checksums(std::move(bytes));
  try {
    fuzzing::require_sound(decode_png("fuzz.png", bytes, size % 2 == 1));
  } catch (const InputError&) {
  }
  try {
    if (const auto alpha = decode_png_alpha("fuzz.png", bytes)) fuzzing::require_sound(*alpha);
  } catch (const InputError&) {
  }
  return 0;
}
