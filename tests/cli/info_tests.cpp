// `alhazen info`: the report and its JSON.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Info : public Command {
 protected:
  nlohmann::json json(const std::string& scene) const {
    const CommandResult result = run({"info", scene, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out);
  }
};

TEST_F(Info, DescribesAScene) {
  const nlohmann::json j = json("scene.pbrt");
  EXPECT_EQ(j["triangles"], 36);
  EXPECT_EQ(j["camera"]["kind"], "perspective");
  EXPECT_EQ(j["cameras"].size(), 1u);
  EXPECT_FALSE(j["lights"].empty());
  EXPECT_EQ(j["lights"][0]["kind"], "area light");
  EXPECT_FALSE(j["materials"].empty());
  EXPECT_FALSE(j["objects"].empty());
  EXPECT_TRUE(j["warnings"].empty());
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(j["bounds"]["min"][axis], j["bounds"]["max"][axis]);
  const CommandResult text = run({"info", "scene.pbrt"});
  for (const char* words : {"bounds", "36 triangles", "perspective, field of view", "24 x 24 pixels", "lights: "})
    EXPECT_NE(text.out.find(words), std::string::npos) << words << "\n" << text.out;
}

TEST_F(Info, ListOfPbrtNamesCameraAndLights) {
  const CommandResult list = run({"info", "scene.pbrt", "--list"});
  EXPECT_NE(list.out.find("cameras: 1\n  0 perspective\n"), std::string::npos) << list.out;
  EXPECT_EQ(list.out.find("lights: 0"), std::string::npos) << list.out;
  EXPECT_NE(list.out.find("area light, scene.pbrt:"), std::string::npos) << list.out;
}

TEST_F(Info, LongListsEndUnlessAllIsAskedFor) {
  std::string scene = "WorldBegin LightSource \"infinite\"\n";
  for (int i = 0; i < 30; ++i) scene += "Shape \"sphere\"\n";
  scene +=
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]\n"
      "ObjectBegin \"leaf\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] \"integer indices\" "
      "[ 0 1 2 1 3 2 ] ObjectEnd ObjectInstance \"leaf\" Translate 1 0 0 ObjectInstance \"leaf\"\n";
  folder_.write_text("many.pbrt", scene);
  const CommandResult few = run({"info", "many.pbrt"}), all = run({"info", "many.pbrt", "--all"});
  EXPECT_NE(few.out.find("objects: 32\n  leaf: 2 triangles, 2 instances"), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("  and 12 more: --all lists them\n"), std::string::npos) << few.out;
  EXPECT_EQ(all.out.find("more: --all"), std::string::npos) << all.out;
  const nlohmann::json j = json("many.pbrt");
  EXPECT_EQ(j["objects"].size(), 32u);
  EXPECT_EQ(j["triangles"], 5);
  EXPECT_EQ(j["stored_triangles"], 3);
  EXPECT_EQ(j["primitives"], 30);
}

TEST_F(Info, NamesImagesAndWhatIsNotSupported) {
  Image picture{20, 10, {"R", "G", "B"}, std::vector(3, std::vector<float>(200, 0.5f))};
  write_png(folder_.file("p.png"), source_of(picture), {});
  folder_.write_text(
      "t.pbrt",
      "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"p.png\"\nMaterial \"hair\" "
      "Shape \"sphere\"");
  const CommandResult result = run({"info", "t.pbrt"});
  EXPECT_NE(result.out.find("p.png: 20 x 10, 3 x 8 bits, 600 bytes"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("replaced: 0"), std::string::npos) << result.out;
  const nlohmann::json j = json("t.pbrt");
  EXPECT_EQ(j["images"][0]["width"], 20);
  EXPECT_EQ(j["image_bytes"], 600);
  EXPECT_FALSE(j["warnings"].empty());
}

}  // namespace

}  // namespace alhazen::impl::test
