// Reads any bytes as a glTF file, compiles the scene and renders a few pixels; invalid files must be refused.

#include "fuzz/render_few_pixels.h"
#include "io/gltf/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  Diagnostics diagnostics;
  ReadOptions options;
  const uint8_t choice = fuzzing::last_of({data, size});
  if (choice % 2 == 1) options.time = 0.3;
  try {
    fuzzing::render_few_pixels(parse_gltf({data, size}, "fuzz.gltf", "/no-such-folder", options, diagnostics),
                               choice / 2, diagnostics);
  } catch (const InputError&) {
  }
  return 0;
}
