// Reads colours and alpha of any bytes as a WebP file: gives as many texels as declared, or an InputError.

#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  const std::span<const uint8_t> bytes(data, size);
  try {
    fuzzing::require_sound(decode_webp("fuzz.webp", bytes));
    if (const auto alpha = decode_webp_alpha("fuzz.webp", bytes)) fuzzing::require_sound(*alpha);
  } catch (const InputError&) {
  }
  return 0;
}
