// `--environment` and infinite lights with images, tested by rendered images.

#include <alhazen/alhazen.h>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Environment : public Command {
 protected:
  /// Red to the left of the centre, green to the right of it, and blue in the upper third.
  Environment() {
    Image map{96, 48, {"R", "G", "B"}, std::vector(3, std::vector<float>(96 * 48))};
    for (size_t i = 0; i < 96 * 48; ++i) map.planes[i / 96 < 16 ? 2 : i % 96 < 48 ? 0 : 1][i] = 1;
    write_exr(folder_.file("map.exr"), source_of(map), {});
    map.width = 90;
    for (auto& plane : map.planes) plane.resize(90 * 48);
    write_exr(folder_.file("odd.exr"), source_of(map), {});
  }

  /// The view along -z, y up, of a scene with a sky of its own.
  static std::string view(const std::string& before) {
    return before + R"( LookAt 0 0 0  0 0 -1  0 1 0
Camera "perspective" "float fov" 120
Film "rgb" "integer xresolution" 9 "integer yresolution" 9
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 5 5 5 ]
)";
  }

  static void expect_colour(const Image& image, int x, int y, const std::vector<float>& rgb) {
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(image.planes[c][static_cast<size_t>(y * image.width + x)], rgb[c], 1e-3f) << x << ", " << y;
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) const {
    const CommandResult result = run(arguments);
    SCOPED_TRACE(result.everything());
    EXPECT_EQ(result.exit_code, 2);
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word;
    EXPECT_FALSE(exists("refused.exr"));
  }
};

TEST_F(Environment, ReplacesTheSkyUprightAndNotMirrored) {
  // Scenes for cameras of both handednesses.
  for (const char* before : {"", "Scale -1 1 1"}) {
    SCOPED_TRACE(before);
    folder_.write_text("view.pbrt", view(before));
    for (const char* integrator : {"path", "iterative", "recursive", "branching"}) {
      ASSERT_EQ(run({"render", "view.pbrt", "--environment", "map.exr", "-o", "view.exr", "--spp", "4", "-q",
                     "--integrator", integrator})
                    .exit_code,
                0);
      const Image rendered = image("view.exr");
      expect_colour(rendered, 1, 4, {1, 0, 0});
      expect_colour(rendered, 7, 4, {0, 1, 0});
      expect_colour(rendered, 1, 8, {1, 0, 0});
      expect_colour(rendered, 4, 0, {0, 0, 1});
    }
  }
}

TEST_F(Environment, OfTheLibraryIsTheSame) {
  folder_.write_text("view.pbrt", view(""));
  ASSERT_EQ(run({"render", "view.pbrt", "--environment", "map.exr", "-o", "view.exr", "--exr-type", "float", "--spp",
                 "4", "-q"})
                .exit_code,
            0);
  const Image expected = image("view.exr");
  Settings settings;
  settings.samples_per_pixel = 4;
  settings.environment = folder_.file("map.exr");
  const RenderedImage rendered = alhazen::render(folder_.file("view.pbrt"), settings);
  EXPECT_TRUE(rendered.warnings.empty());
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(rendered.planes[c], expected.planes[c]);
  settings.environment = folder_.file("odd.exr");
  EXPECT_THROW(alhazen::render(folder_.file("view.pbrt"), settings), std::runtime_error);
}

TEST_F(Environment, LightsMeshesAlone) {
  folder_.write_text("mesh.ply",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                     "3 0 1 2\n");
  const CommandResult result =
      run({"render", "mesh.ply", "--environment", "map.exr", "-o", "mesh.exr", "--spp", "1", "--size", "9x9", "-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const Image rendered = image("mesh.exr");
  const size_t corner = 8 * 9;  // behind and below the mesh: not the white sky that meshes get otherwise
  EXPECT_LT(rendered.planes[0][corner] + rendered.planes[1][corner] + rendered.planes[2][corner], 1.01f);
}

TEST_F(Environment, WhatIsRefused) {
  const std::vector<std::string> start{"render", "scene.pbrt", "-o", "refused.exr", "--environment"};
  const auto with = [&](const std::string& file) {
    std::vector<std::string> all = start;
    all.push_back(file);
    return all;
  };
  expect_refused(with("no.exr"), {"no.exr: "});
  expect_refused(with("scene.pbrt"), {"scene.pbrt: "});
  expect_refused(with("odd.exr"), {"odd.exr: ", "90 x 48", "twice as wide as high"});
  folder_.write_text("bad.pbrt", "WorldBegin\nLightSource \"infinite\" \"string filename\" \"odd.exr\"\n");
  expect_refused({"render", "bad.pbrt", "-o", "refused.exr"}, {"bad.pbrt:2:24: ", "90 x 48", "convert"});
  folder_.write_text("bad.pbrt", "WorldBegin\n  LightSource \"infinite\" \"string filename\" \"no.exr\"\n");
  expect_refused({"render", "bad.pbrt", "-o", "refused.exr"}, {"bad.pbrt:2:26: ", "no.exr"});
}

TEST_F(Environment, CheckpointsTellMapsApart) {
  const std::vector<std::string> start{"render", "scene.pbrt", "-o",           "a.exr", "-q",
                                       "--spp",  "4",          "--checkpoint", "state"};
  ASSERT_EQ(run(start).exit_code, 0);
  std::vector<std::string> other = start;
  other.insert(other.end(), {"--resume", "--environment", "map.exr"});
  const CommandResult result = run(other);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("another scene"), std::string::npos) << result.everything();
}

}  // namespace

}  // namespace alhazen::impl::test
