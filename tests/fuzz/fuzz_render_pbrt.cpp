// Reads any bytes as a scene text, compiles the scene and renders a few pixels; invalid texts must be refused.

#include <string>

#include "fuzz/render_few_pixels.h"
#include "io/pbrt/pbrt.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  std::string text(reinterpret_cast<const char*>(data), size);
  // Without slashes and in a folder that does not exist, no name refers to a file.
  std::replace(text.begin(), text.end(), '/', '_');
  Diagnostics diagnostics;
  try {
    fuzzing::render_few_pixels(parse_pbrt(text, "fuzz.pbrt", "/no-such-folder", diagnostics),
                               fuzzing::last_of({data, size}), diagnostics);
  } catch (const InputError&) {
  }
  return 0;
}
