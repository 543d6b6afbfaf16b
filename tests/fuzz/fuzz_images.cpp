// Reads any bytes as a file of one of the formats without a target of their own (JPEG, TGA, BMP, PFM), selected by the
// last byte: gives as many texels as declared, or an InputError.

#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen;
  if (size == 0) return 0;
  constexpr auto decoders = std::to_array({decode_jpeg, decode_tga, decode_bmp, decode_pfm});
  try {
    fuzzing::require_sound(decoders[data[size - 1] % decoders.size()]("fuzz", {data, size - 1}));
  } catch (const InputError&) {
  }
  return 0;
}
