// glTF files on the command line: the cameras, variants and animations that they offer, and the messages for invalid
// choices and files.

#include <algorithm>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

/// A triangle that moves to the right, in front of two cameras, green except in its two variants, under a light.
const char* const scene = R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_materials_variants", "KHR_lights_punctual"],
  "extensions": {
    "KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]},
    "KHR_lights_punctual": {"lights": [{"type": "directional", "name": "sun", "intensity": 3}]}
  },
  "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAACBCAAAAAAAAAAA="}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                  {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0}},
                {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1], "metallicFactor": 0}},
                {"pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1], "metallicFactor": 0}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 2, "extensions": {"KHR_materials_variants":
    {"mappings": [{"material": 0, "variants": [0]}, {"material": 1, "variants": [1]}]}}}]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
  "nodes": [{"mesh": 0}, {"name": "near", "camera": 0, "translation": [0, 0, 4]},
            {"name": "far", "camera": 0, "translation": [0, 0, 400]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "animations": [{"name": "leave", "samplers": [{"input": 1, "output": 2}],
                  "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
})";

class Gltf : public Command {
 protected:
  Gltf() { folder_.write_text("scene.gltf", scene); }

  /// The sums of red, green and blue of a small image.
  std::array<double, 3> colours(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"render", "scene.gltf", "--size", "16x16", "--spp", "4", "-q", "-o", "out.exr"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Image rendered = image("out.exr");
    const auto sum = [&](const char* channel) {
      double total = 0;
      for (const float value : rendered.planes.at(static_cast<size_t>(rendered.channel(channel))))
        total += static_cast<double>(value);
      return total;
    };
    return {sum("R"), sum("G"), sum("B")};
  }
};

TEST_F(Gltf, RendersThePrimitivesOwnMaterialByTheFirstCamera) {
  const auto [red, green, blue] = colours({});
  EXPECT_GT(green, 10);
  EXPECT_LT(red, green / 4);
  EXPECT_LT(blue, green / 4);
}

TEST_F(Gltf, RendersAnotherVariantCameraAndTime) {
  for (const char* const name : {"blue", "1"}) {
    const auto [red, green, blue] = colours({"--variant", name});
    EXPECT_GT(blue, 10);
    EXPECT_LT(red, blue / 4);
    EXPECT_LT(green, blue / 4);
  }
  EXPECT_GT(colours({"--variant", "red"})[0], 10);
  EXPECT_LT(colours({"--camera", "far"})[1], 0.1 * colours({"--camera", "0"})[1]);
  EXPECT_EQ(colours({"--time", "1"})[1], 0);
  EXPECT_GT(colours({"--time", "0", "--animation", "leave"})[1], 10);
}

TEST_F(Gltf, DarkensThePngOfLightsThatAreMuchTooBright) {
  std::string text = scene;
  text.replace(text.find("\"intensity\": 3"), 14, "\"intensity\": 3e4");
  folder_.write_text("sun.gltf", text);
  const auto green = [&](const std::string& file, const std::vector<std::string>& further) {
    std::vector<std::string> all{"render", file, "--size", "16x16", "--spp", "4", "-o", "out.png"};
    all.insert(all.end(), further.begin(), further.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Image rendered = image("out.png");
    float largest = 0;
    for (const float value : rendered.planes.at(static_cast<size_t>(rendered.channel("G"))))
      largest = std::max(largest, value);
    return std::pair{largest, result.err.find("exposure: auto chose -") != std::string::npos};
  };
  const auto [fitted, is_said] = green("sun.gltf", {});
  EXPECT_LT(fitted, 0.99f);
  EXPECT_GT(fitted, 0.3f);
  EXPECT_TRUE(is_said);
  const auto [asked, is_said_again] = green("sun.gltf", {"--exposure", "0"});
  EXPECT_EQ(asked, 1);
  EXPECT_FALSE(is_said_again);
  EXPECT_FALSE(green("scene.gltf", {}).second);

  // Nor does a sky over most of the image hide that the triangle is too bright, since it is known where it is.
  folder_.write_text("sky.pfm", "PF\n2 1\n-1.0\n" + std::string(24, '>'));
  const auto [beside_sky, is_said_beside_sky] = green("sun.gltf", {"--environment", "sky.pfm", "--denoise", "builtin"});
  EXPECT_TRUE(is_said_beside_sky);
  EXPECT_LT(beside_sky, 0.99f);
  EXPECT_GT(beside_sky, 0.3f);
}

TEST_F(Gltf, ListsWhatMayBeChosen) {
  const CommandResult result = run({"info", "scene.gltf", "--list", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json list = only_json(result.out);
  EXPECT_EQ(list["cameras"], (nlohmann::json{"near", "far"}));
  EXPECT_EQ(list["variants"], (nlohmann::json{"red", "blue"}));
  EXPECT_EQ(list["animations"], nlohmann::json{"leave"});
  EXPECT_EQ(list["lights"], nlohmann::json{"sun"});
  const nlohmann::json lights = only_json(run({"info", "scene.gltf", "--json"}).out)["lights"];
  EXPECT_EQ(lights.at(0)["name"], "sun");
  EXPECT_NE(run({"render", "scene.gltf", "--list"}).out.find("  1 far\n"), std::string::npos);
}

TEST_F(Gltf, RefusesWhatIsNotThere) {
  for (const std::vector<std::string>& choice :
       {std::vector<std::string>{"--camera", "third"}, {"--variant", "2"}, {"--animation", "9"}}) {
    std::vector<std::string> all{"render", "scene.gltf"};
    all.insert(all.end(), choice.begin(), choice.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("it may be one of"), std::string::npos) << result.err;
  }
  const CommandResult pbrt = run({"render", "scene.pbrt", "--camera", "near"});
  EXPECT_EQ(pbrt.exit_code, 2);
  EXPECT_NE(pbrt.err.find("glTF files only"), std::string::npos) << pbrt.err;
}

TEST_F(Gltf, TellsWhereAFileIsBad) {
  std::string text = scene;
  text.replace(text.find("\"mesh\": 0"), 9, "\"mesh\": 5");
  folder_.write_text("bad.gltf", text);
  const CommandResult result = run({"render", "bad.gltf"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("bad.gltf:20:22: index out of range: \"meshes\" has 1 items"), std::string::npos)
      << result.err;
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
}

}  // namespace

}  // namespace alhazen::impl::test
