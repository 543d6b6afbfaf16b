// Reads any bytes as an EXR file: gives planes of the declared size, or an InputError.

#include "fuzz/memory_file.h"
#include "fuzz/sound_texels.h"
#include "images/codecs/decoders.h"
#include "images/read_texture.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  const fuzzing::MemoryFile file(data, size);
  try {
    const Image image = read_exr(file.path());
    fuzzing::require(image.width > 0 && image.height > 0 && image.planes.size() == image.channels.size());
    for (const std::vector<float>& plane : image.planes)
      fuzzing::require(plane.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    fuzzing::require_sound(read_texture(file.path(), TextureEncoding::automatic));
  } catch (const InputError&) {
  }
  return 0;
}
