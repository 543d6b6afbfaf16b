// Reads any bytes as a Radiance HDR file: gives as many texels as declared, or an InputError.

#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  try {
    fuzzing::require_sound(decode_hdr("fuzz.hdr", {data, size}));
  } catch (const InputError&) {
  }
  return 0;
}
