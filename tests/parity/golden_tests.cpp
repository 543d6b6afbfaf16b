// The bits of images of scenes of all kinds, by every integrator, precision and CPU engine, against the checksums in
// golden.txt. After an intended change, rewrite the file and mention it in the commit:
//   ALHAZEN_WRITE_GOLDEN=1 build/release/tests/parity_tests --gtest_filter='Scenes/GoldenImages*'

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "io/read_scene.h"
#include "support/bits.h"
#include "support/external_scenes.h"

namespace alhazen::impl::test {
namespace {

namespace fs = std::filesystem;

const std::string golden_file = ALHAZEN_SOURCE_DIR "/tests/parity/golden.txt";

/// Checksums by scene, integrator, precision and engine.
std::map<std::string, std::string> read_golden() {
  std::map<std::string, std::string> golden;
  std::ifstream file(golden_file);
  for (std::string line; std::getline(file, line);) {
    const size_t last = line.rfind(' ');
    if (line.starts_with('#') || last == std::string::npos) continue;
    golden[line.substr(0, last)] = line.substr(last + 1);
  }
  return golden;
}

void write_golden(const std::map<std::string, std::string>& golden) {
  std::ofstream file(golden_file);
  file << "# scene, integrator, precision, engine, CRC-32 of the image; written by golden_tests.cpp\n";
  for (const auto& [key, checksum] : golden) file << key << ' ' << checksum << '\n';
  ASSERT_TRUE(file.flush()) << golden_file;
}

std::string checksum_of(const Outcome& outcome) {
  const auto* bytes = reinterpret_cast<const Bytef*>(outcome.rows.data());
  std::ostringstream text;
  text << std::hex << crc32_z(0, bytes, outcome.rows.size() * sizeof(float));
  return text.str();
}

struct Engine {
  const char* backend;
  const char* strategy;
};

/// All of these engines give the same bits. The GPU kernels do not support recursive integrators.
std::vector<Engine> engines_for(const std::string& integrator) {
  if (integrator == "path")
    return {{"openmp", "tiles"},     {"openmp", "rows"},     {"openmp", "collapse"},
            {"openmp", "reduction"}, {"cuda", "persistent"}, {"cuda", "wavefront"}};
  if (integrator == "iterative") return {{"openmp", "tiles"}, {"cuda", "persistent"}};
  return {{"openmp", "tiles"}};
}

Settings settings_for(const std::string& integrator, const std::string& precision) {
  Settings settings;
  settings.backend = "serial";
  settings.integrator = integrator;
  settings.precision = precision;
  settings.samples_per_pixel = 2;
  settings.max_depth = 4;
  settings.width = 24;
  settings.height = 18;
  settings.threads = 2;
  settings.aovs = {"albedo", "normal"};
  return settings;
}

class GoldenImages : public ::testing::TestWithParam<const char*> {};

TEST_P(GoldenImages, KeepTheirBits) {
  const std::string name = GetParam();
  const bool is_ours = name.starts_with("scenes/");
  const fs::path file = is_ours ? fs::path(ALHAZEN_SOURCE_DIR) / name : external_scenes() / name;
  if (!fs::exists(file)) GTEST_SKIP() << "the scene is not here: " << name;
  const bool writes = std::getenv("ALHAZEN_WRITE_GOLDEN") != nullptr;
  std::map<std::string, std::string> golden = read_golden();
  Diagnostics diagnostics;
  const Scene scene = read_scene(file.string(), diagnostics);

  const auto check = [&](const std::string& key, const Outcome& outcome) {
    const std::string checksum = checksum_of(outcome);
    if (writes)
      golden[key] = checksum;
    else
      EXPECT_EQ(checksum, golden[key]) << key;
  };
  for (const char* precision : {"float", "double"})
    for (const char* integrator : {"path", "iterative", "recursive", "branching"}) {
      const std::string key = name + ' ' + integrator + ' ' + precision + ' ';
      Settings settings = settings_for(integrator, precision);
      const Outcome image = render_bits(scene, settings);
      check(key + "all", image);
      for (const Engine& engine : engines_for(integrator)) {
        settings.backend = engine.backend;
        settings.strategy = engine.strategy;
        settings.device = settings.backend == "cuda" ? "host" : "";
        EXPECT_TRUE(same_bits(image, render_bits(scene, settings))) << key << engine.backend << ' ' << engine.strategy;
      }
#if ALHAZEN_WITH_EMBREE
      if (std::string(precision) == "double") continue;
      settings.backend = "embree", settings.strategy = "auto", settings.device = "";
      check(key + "embree", render_bits(scene, settings));
#endif
    }
  if (writes) write_golden(golden);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GoldenImages,
    ::testing::Values("scenes/cornell.pbrt", "scenes/furnace.pbrt", "scenes/mesh.pbrt", "scenes/spheres.pbrt",
                      "scenes/weekend.pbrt", "pbrt/cornell-box-variants/cornell-box-silver.pbrt",
                      "pbrt/cornell-box-variants/cornell-box-specular.pbrt", "pbrt/killeroos/killeroo-moving.pbrt",
                      "pbrt/veach-mis/scene-v4.pbrt", "pbrt/veach-bidir/scene-v4.pbrt",
                      "pbrt/staircase2/staircase2.pbrt", "pbrt/coffee/scene-v4.pbrt",
                      "pbrt/material-testball/material-testball.pbrt", "gltf/IridescenceSuzanne/IridescenceSuzanne.glb",
                      "gltf/ClearCoatTest/ClearCoatTest.glb", "gltf/AnisotropyDisc/AnisotropyDiscTest.glb",
                      "gltf/AttenuationTest/AttenuationTest.glb", "gltf/TeapotsGalore/TeapotsGalore.gltf",
                      "gltf/GlassTable/glass-table.glb", "gltf/TextureSettingsTest/TextureSettingsTest.glb"),
    [](const auto& param_info) {
      std::string name = param_info.param;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

}  // namespace
}  // namespace alhazen::impl::test
