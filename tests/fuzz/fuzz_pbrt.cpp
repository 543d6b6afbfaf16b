// libFuzzer target: any bytes as a scene text. Errors are what the reader must give for almost all of them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "io/pbrt/pbrt.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  // Without slashes, and in a folder that does not exist, no name can lead to a file.
  std::replace(text.begin(), text.end(), '/', '_');
  alhazen::Diagnostics diagnostics;
  try {
    alhazen::parse_pbrt(text, "fuzz.pbrt", "/no-such-folder", diagnostics);
  } catch (const alhazen::InputError&) {
  }
  return 0;
}
