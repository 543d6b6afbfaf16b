// `--quality`: what each sets, what counts beside it, and the one that glTF files have by default.

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include "alhazen/alhazen.h"
#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class QualityOption : public Command {
 protected:
  QualityOption() { folder_.write_text("scene.gltf", gltf(3)); }

  /// A triangle before a camera, under a light.
  static std::string gltf(double intensity) {
    return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": )" +
           std::to_string(intensity) + R"(}]}},
  "buffers": [{"byteLength": 36,
    "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
  "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}]
})";
  }

  CommandResult result_of(const std::string& scene, const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{"render", scene,          "--size",     "16x16", "-o",
                                 "a.exr",  "--stats=json", "--progress", "none"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all);
  }

  nlohmann::json statistics(const std::string& scene, const std::vector<std::string>& arguments) const {
    const CommandResult result = result_of(scene, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return only_json(result.out);
  }

  /// The attribute of the EXR that was written last.
  std::string attribute(const char* name) const {
    const Imf::InputFile file(folder_.file("a.exr").c_str());
    const auto* attribute = file.header().findTypedAttribute<Imf::StringAttribute>(name);
    return attribute ? attribute->value() : "none";
  }
};

TEST_F(QualityOption, SetsSamplesNoiseAndDenoiser) {
  const nlohmann::json draft = statistics("scene.pbrt", {"--quality", "draft"});
  EXPECT_EQ(draft["quality"], "draft");
  EXPECT_EQ(draft["spp"], 16);
  EXPECT_FALSE(draft.contains("noise"));
  EXPECT_NE(draft["denoiser"], "none");
  EXPECT_EQ(attribute("quality"), "draft: --spp 16 --denoise auto");

  const nlohmann::json good = statistics("scene.pbrt", {"--quality", "good"});
  EXPECT_EQ(good["noise"]["target"], 0.02);
  EXPECT_EQ(good["noise"]["measure"], "display");
  EXPECT_EQ(good["noise"]["most_spp"], 1024);
  EXPECT_NE(good["denoiser"], "none");
  EXPECT_EQ(attribute("quality"), "good: --spp 1024 --noise 0.02,display --denoise auto");

  const nlohmann::json final = statistics("scene.pbrt", {"--quality", "final", "--spp", "64"});
  EXPECT_EQ(final["noise"]["target"], 0.01);
  EXPECT_EQ(final["noise"]["most_spp"], 64);
  EXPECT_EQ(final["denoiser"], "none");
}

TEST_F(QualityOption, OptionsBesideItCount) {
  const nlohmann::json others =
      statistics("scene.pbrt", {"--spp", "40", "--quality", "good", "--noise", "0.3", "--denoise", "none"});
  EXPECT_EQ(others["quality"], "good");
  EXPECT_EQ(others["noise"]["target"], 0.3);
  EXPECT_EQ(others["noise"]["measure"], "relative");
  EXPECT_EQ(others["noise"]["most_spp"], 40);
  EXPECT_EQ(others["denoiser"], "none");
  const nlohmann::json uniform = statistics("scene.pbrt", {"--quality", "good", "--noise", "none", "--spp", "3"});
  EXPECT_FALSE(uniform.contains("noise"));
  EXPECT_EQ(uniform["spp"], 3);
  EXPECT_NE(uniform["denoiser"], "none");
}

TEST_F(QualityOption, PbrtFilesHaveNone) {
  const nlohmann::json j = statistics("scene.pbrt", {});
  EXPECT_EQ(j["quality"], "none");
  EXPECT_FALSE(j.contains("noise"));
  EXPECT_EQ(j["denoiser"], "none");
  EXPECT_EQ(attribute("quality"), "none");
}

TEST_F(QualityOption, OfGltfFilesIsGoodUnlessSamplesNoiseOrDenoiserAreGiven) {
  const CommandResult result = result_of("scene.gltf", {});
  EXPECT_NE(result.err.find("quality good: "), std::string::npos) << result.err;
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  const nlohmann::json good = only_json(result.out);
  EXPECT_EQ(good["quality"], "good");
  EXPECT_EQ(good["noise"]["target"], 0.02);
  EXPECT_NE(good["denoiser"], "none");
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--spp", "4"},
                                                  {"--noise", "0.5"},
                                                  {"--noise", "none"},
                                                  {"--denoise", "builtin"},
                                                  {"--denoise", "none"}}) {
    SCOPED_TRACE(options[0] + " " + options[1]);
    const nlohmann::json j = statistics("scene.gltf", options);
    EXPECT_EQ(j["quality"], "none");
    EXPECT_EQ(j.contains("noise"), options[1] == "0.5");
    EXPECT_EQ(j["denoiser"], options[1] == "builtin" ? "builtin" : "none");
    if (options[0] != "--spp" && options[1] != "0.5") {
      EXPECT_EQ(j["spp"], 64);
    }
  }
  EXPECT_EQ(statistics("scene.gltf", {"--quality", "draft"})["quality"], "draft");
  EXPECT_EQ(statistics("scene.gltf", {"--seed", "3", "--max-depth", "2"})["quality"], "good");
}

/// Where the exposure follows from the image, the noise that is displayed does too: lights of any brightness take the
/// same samples.
TEST_F(QualityOption, KnowsTheExposureThatTheImageWillHave) {
  folder_.write_text("bright.gltf", gltf(3 * 4096));
  folder_.write_text("brighter.gltf", gltf(3 * 65536));
  const auto rendered = [&](const std::string& name) {
    return statistics(name + ".gltf", {"--quality", "good", "--denoise", "none", "-o", name + ".png"});
  };
  const nlohmann::json bright = rendered("bright"), brighter = rendered("brighter");
  EXPECT_EQ(bright["noise"]["mean_spp"], brighter["noise"]["mean_spp"]);
  EXPECT_GT(bright["noise"]["reached"], 0);
  EXPECT_EQ(bright["noise"]["reached"], brighter["noise"]["reached"]);
  EXPECT_EQ(image("bright.png").planes, image("brighter.png").planes);
  const nlohmann::json white = statistics("bright.gltf", {"--quality", "good", "--exposure", "0"});
  EXPECT_NE(white["noise"]["reached"], bright["noise"]["reached"]) << "an exposure that is given counts";
}

TEST_F(QualityOption, OthersAreRefused) {
  for (const char* wrong : {"best", "", "Good", "good,draft"}) {
    const CommandResult result = result_of("scene.pbrt", {"--quality", wrong});
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_EQ(result.err, "--quality must be one of draft, good, final, not '" + std::string(wrong) + "'\n");
  }
  EXPECT_FALSE(exists("a.exr"));
  Settings settings;
  settings.quality = "best";
  try {
    alhazen::render(folder_.file("scene.pbrt"), settings);
    FAIL() << "not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "unknown quality 'best': it may be draft, good, final");
  }
}

TEST_F(QualityOption, ACheckpointIsResumedWithTheSame) {
  const nlohmann::json whole = statistics("scene.gltf", {"--quality", "good"});
  const Image expected = image("a.exr");
  ASSERT_EQ(result_of("scene.gltf", {"--quality", "good", "--spp", "16", "--checkpoint", "c"}).exit_code, 0);
  // The default is good as well.
  EXPECT_EQ(statistics("scene.gltf", {"--checkpoint", "c", "--resume"})["noise"], whole["noise"]);
  EXPECT_EQ(image("a.exr").planes, expected.planes);
  const CommandResult other = result_of("scene.gltf", {"--quality", "draft", "--checkpoint", "c", "--resume"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(
      other.err.find("it was written with noise 0.02 displayed at the image's exposure by tone map none, and this "
                     "render has none of that"),
      std::string::npos)
      << other.err;
}

TEST_F(QualityOption, TheLibraryHasItToo) {
  Settings settings;
  settings.width = settings.height = 16;
  const RenderedImage plain = alhazen::render(folder_.file("scene.pbrt"), settings);
  EXPECT_EQ(plain.quality, "");
  EXPECT_EQ(plain.denoiser, "");
  EXPECT_FALSE(plain.noise.has_value());
  const RenderedImage model = alhazen::render(folder_.file("scene.gltf"), settings);
  EXPECT_EQ(model.quality, "good");
  settings.quality = "good";
  settings.samples_per_pixel = 40;
  settings.denoiser = "builtin";
  const RenderedImage good = alhazen::render(folder_.file("scene.pbrt"), settings);
  EXPECT_EQ(good.quality, "good");
  EXPECT_EQ(good.denoiser, "builtin");
  ASSERT_TRUE(good.noise.has_value());
  EXPECT_GT(good.noise->noise, 0);
  EXPECT_GE(good.noise->mean_samples, 16);
  EXPECT_LE(good.noise->mean_samples, 40);
  EXPECT_LE(good.noise->below, 1);
}

}  // namespace

}  // namespace alhazen::impl::test
