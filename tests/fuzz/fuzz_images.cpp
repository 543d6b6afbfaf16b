// Reads any bytes as a file of one of the formats without a target of their own (JPEG, TGA, BMP, PFM, QOI), selected by
// the last byte: reads colours and alpha; gives as many texels as declared, or an InputError.

#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  if (size == 0) return 0;
  struct Decoders {
    ImageTexels (*colours)(const std::string&, std::span<const uint8_t>);
    std::optional<ImageTexels> (*alpha)(const std::string&, std::span<const uint8_t>);
  };
  constexpr auto formats = std::to_array<Decoders>({{decode_jpeg, nullptr},
                                                    {decode_tga, decode_tga_alpha},
                                                    {decode_bmp, decode_bmp_alpha},
                                                    {decode_pfm, nullptr},
                                                    {decode_qoi, decode_qoi_alpha}});
  const Decoders& decode = formats[data[size - 1] % formats.size()];
  const std::span<const uint8_t> bytes(data, size - 1);
  try {
    fuzzing::require_sound(decode.colours("fuzz", bytes));
    if (decode.alpha == nullptr) return 0;
    if (const auto alpha = decode.alpha("fuzz", bytes)) fuzzing::require_sound(*alpha);
  } catch (const InputError&) {
  }
  return 0;
}
