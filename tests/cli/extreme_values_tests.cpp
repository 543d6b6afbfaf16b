// Transforms, radiances and colours at the ends of their ranges: an error with its place, or a warning.

#include "cli/fixture.h"
#include "support/animated_gltf.h"

namespace alhazen::impl::test {

namespace {

class ExtremeValues : public Command {
 protected:
  CommandResult rendered(const std::string& name, const std::string& text, std::vector<std::string> more = {}) const {
    folder_.write_text(name, text);
    more.insert(more.begin(), {"render", name, "--size", "8x8", "--spp", "2", "--progress", "none", "-o", "r.pfm"});
    return run(more);
  }

  void expect_refused(const CommandResult& result, const std::string& place) const {
    EXPECT_EQ(result.exit_code, 2) << place << result.everything();
    EXPECT_NE(("\n" + result.err).find("\n" + place), std::string::npos) << place << "\n" << result.err;
    EXPECT_FALSE(exists("r.pfm"));
  }

  static std::string pbrt(const std::string& world) {
    return "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" + world + "\n";
  }
};

TEST_F(ExtremeValues, ShapesThatReachTooFarForACamera) {
  const std::string scale = "<transform name=\"to_world\"><scale value=\"1e300\"/></transform>";
  const auto mitsuba = [](const std::string& shapes) { return "<scene version=\"3.0.0\">\n" + shapes + "</scene>\n"; };
  expect_refused(rendered("a.xml", mitsuba("<shape type=\"sphere\">" + scale + "</shape>")), "a.xml:2:1: ");
  expect_refused(rendered("b.xml", mitsuba("<shape type=\"sphere\"/>\n <shape type=\"cube\">" + scale + "</shape>")),
                 "b.xml:3:2: ");
  expect_refused(rendered("c.xml", mitsuba("<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"/></shape>\n"
                                           "<shape type=\"instance\"><ref id=\"g\"/>" +
                                           scale + "</shape>")),
                 "c.xml:");
  for (const std::vector<std::string>& view :
       {std::vector<std::string>{"--fit"}, {"--orbit", "20,10"}, {"--turntable", "3"}, {"--orbit", "20,10,1e5"}}) {
    std::vector<std::string> arguments{"render", "s.pbrt", "--size", "8x8", "--spp", "1", "-q", "-o", "r_#.pfm"};
    arguments.insert(arguments.end(), view.begin(), view.end());
    folder_.write_text("s.pbrt", pbrt("LightSource \"infinite\"\nScale 1e300 1e300 1e300\nShape \"sphere\""));
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(("\n" + result.err).find("\ns.pbrt:6:1: "), std::string::npos) << view[0] << result.err;
  }
  expect_refused(rendered("m.obj", "v 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n"), "m.obj:");
}

TEST_F(ExtremeValues, OfNodesOfGltf) {
  write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {-1, 0, 0, 1, 0, 0}}});
  const Bytes bytes = read_file(folder_.file("moving.gltf"));
  for (const char* scale : {"1e300", "1e200"}) {
    nlohmann::json json = nlohmann::json::parse(std::string(bytes.begin(), bytes.end()));
    json.erase("cameras");
    json.erase("animations");
    for (nlohmann::json& node : json["nodes"]) {
      node.erase("camera");
      node["scale"] = std::vector<double>(3, std::stod(scale));
    }
    const CommandResult result = rendered("scaled.gltf", json.dump());
    EXPECT_EQ(result.exit_code, 2) << scale << result.everything();
    EXPECT_EQ(result.err.find("scaled.gltf"), 0u) << result.err;
    EXPECT_EQ(result.err.find("cannot be inverted"), std::string::npos) << result.err;
  }
}

/// Every sample is finite, and their sum is not.
TEST_F(ExtremeValues, APixelThatIsInfiniteIsSaid) {
  const std::string warning = "64 pixels of the image are infinite or NaN";
  const CommandResult bright =
      rendered("bright.pbrt", pbrt("LightSource \"infinite\" \"rgb L\" [ 2.5e38 2.5e38 2.5e38 ]"), {"--seed", "1"});
  EXPECT_EQ(bright.exit_code, 0) << bright.everything();
  EXPECT_NE(bright.err.find(warning), std::string::npos) << bright.err;
  const CommandResult mitsuba =
      rendered("bright.xml",
               "<scene version=\"3.0.0\"><emitter type=\"constant\"><rgb name=\"radiance\" value=\"2.5e38 2.5e38 "
               "2.5e38\"/></emitter><sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor></scene>");
  EXPECT_NE(mitsuba.err.find(warning), std::string::npos) << mitsuba.everything();
  const CommandResult dim = rendered("dim.pbrt", pbrt("LightSource \"infinite\" \"rgb L\" [ 1e30 1e30 1e30 ]"));
  EXPECT_EQ(dim.err.find("infinite or NaN"), std::string::npos) << dim.err;
}

TEST_F(ExtremeValues, ColoursOfVertices) {
  const auto ply = [](const std::string& red) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
           "float red\nproperty float green\nproperty float blue\nelement face 1\nproperty list uchar int "
           "vertex_indices\nend_header\n0 0 0 1 0 0\n1 0 0 " +
           red + " 0 0\n0 1 0 1 0 0\n3 0 1 2\n";
  };
  const auto obj = [](const std::string& red) {
    return "v 0 0 0 1 0 0\nv 1 0 0 " + red + " 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
  };
  for (const std::string red : {"nan", "inf", "-inf"}) {
    expect_refused(rendered("m.ply", ply(red)), "m.ply:14:");
    expect_refused(rendered("m.obj", obj(red)), "m.obj:2:9: ");
  }
  for (const std::string red : {"2.5", "-1"}) {
    for (const auto& [name, text] : {std::pair{"m.ply", ply(red)}, std::pair{"m.obj", obj(red)}}) {
      const CommandResult result = rendered(name, text);
      EXPECT_EQ(result.exit_code, 0) << result.everything();
      EXPECT_NE(result.err.find("clamped"), std::string::npos) << name << result.err;
    }
  }
  for (const auto& [name, text] : {std::pair{"m.ply", ply("0.5")}, std::pair{"m.obj", obj("0.5")}})
    EXPECT_EQ(rendered(name, text).err.find("clamped"), std::string::npos) << name;
}

}  // namespace

}  // namespace alhazen::impl::test
