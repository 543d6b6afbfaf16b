// Resumes a render from any bytes as a checkpoint, or from a saved one with some bytes changed: gives an InputError, or
// all samples.

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fuzz/render_few_pixels.h"
#include "io/pbrt/pbrt.h"

namespace {

using namespace alhazen::impl;

constexpr const char* scene_text = R"(
Film "rgb" "integer xresolution" 3 "integer yresolution" 2
PixelFilter "mitchell"
WorldBegin
LightSource "infinite"
Shape "sphere" "float radius" 0.5
)";

constexpr int samples = 8;

/// A folder that is removed when the fuzzer ends normally.
class Folder {
 public:
  Folder() {
    if (mkdtemp(name_.data()) == nullptr) std::abort();
  }
  ~Folder() { std::filesystem::remove_all(name_); }
  std::string file() const { return name_ + "/state"; }

 private:
  std::string name_ = (std::filesystem::temp_directory_path() / "alhazen-fuzz-XXXXXX").string();
};

Rendering render(const std::string& checkpoint, int64_t samples_per_pixel, bool resume) {
  Diagnostics diagnostics;
  Scene scene = parse_pbrt(scene_text, "fuzz.pbrt", "/no-such-folder", diagnostics);
  omp_set_num_threads(1);
  Settings asked;
  asked.backend = "serial";
  asked.threads = 1;
  asked.samples_per_pixel = samples_per_pixel;
  asked.aovs = {"alpha", "albedo", "normal",      "depth",   "distance", "position",
                "uv",    "object", "cryptomatte", "bounces", "samples",  "variance"};
  asked.checkpoint = checkpoint;
  asked.resume = resume;
  const RenderSettings settings = resolve_settings(asked, scene);
  return render_scene(std::move(scene), settings, 0, {}, diagnostics);
}

std::string saved_checkpoint(const std::string& path) {
  render(path, samples / 2, false);
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// Triples of an offset (two bytes) and a value to store there.
std::string changed(std::string state, std::span<const uint8_t> changes) {
  for (; changes.size() >= 3; changes = changes.subspan(3))
    state[(changes[0] * 256u + changes[1]) % state.size()] = static_cast<char>(changes[2]);
  return state;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const Folder folder;
  static const std::string saved = saved_checkpoint(folder.file());
  if (size == 0) return 0;
  const std::span<const uint8_t> rest(data + 1, size - 1);
  const std::string state = data[0] % 2 == 0 ? std::string(rest.begin(), rest.end()) : changed(saved, rest);
  std::ofstream(folder.file(), std::ios::binary | std::ios::trunc) << state;
  try {
    const Rendering rendering = render(folder.file(), samples, true);
    if (!rendering.statistics.complete) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
