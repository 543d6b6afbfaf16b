// Uses any bytes as an image of whatever format they begin with, for all purposes of images in a scene: an environment
// map, a goniometric light, textures of colour, roughness, alpha and displacement.

#include <string>

#include "fuzz/memory_file.h"
#include "fuzz/render_few_pixels.h"
#include "io/pbrt/pbrt.h"

namespace {

constexpr const char* scene_text = R"(
LookAt 0 -3 1  0 0 0  0 0 1
Camera "perspective" "float fov" 50
WorldBegin
LightSource "infinite" "string filename" "IMAGE"
LightSource "goniometric" "string filename" "IMAGE" "float power" 10
LightSource "projection" "string filename" "IMAGE"
Texture "colour" "spectrum" "imagemap" "string filename" "IMAGE" "string wrap" "clamp"
Texture "number" "float" "imagemap" "string filename" "IMAGE" "float uscale" 3 "string filter" "point"
Material "diffuse" "texture reflectance" "colour" "texture displacement" "number"
Shape "sphere" "float radius" 1 "texture alpha" "number"
Material "conductor" "texture reflectance" "colour" "texture roughness" "number"
Shape "bilinearmesh" "point3 P" [ -4 -4 -1  4 -4 -1  -4 4 -1  4 4 -1 ]
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  const fuzzing::MemoryFile file(data, size);
  // If the image is refused for one purpose, such as a light's if it is not square, the others are still tried.
  for (const std::string kept : {"infinite", "goniometric", "projection", "none"}) {
    std::string text;
    for (std::string rest = scene_text; !rest.empty();) {
      const size_t end = rest.find('\n') + 1;
      std::string line = rest.substr(0, end);
      rest.erase(0, end);
      if (line.starts_with("LightSource") && line.find(kept) == std::string::npos) continue;
      if (const size_t name = line.find("IMAGE"); name != std::string::npos) line.replace(name, 5, file.path());
      text += line;
    }
    Diagnostics diagnostics;
    try {
      fuzzing::render_few_pixels(parse_pbrt(text, "fuzz.pbrt", "/", diagnostics), fuzzing::last_of({data, size}),
                                 diagnostics);
    } catch (const InputError&) {
    }
  }
  return 0;
}
