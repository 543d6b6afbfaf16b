// Rendered images of pbrt scenes, from the command line.

#include <algorithm>

#include "cli/fixture.h"
#include "unit/images/image_files.h"

namespace alhazen::impl::test {

namespace {

class PbrtScenes : public Command {
 protected:
  /// The mean of green over the rendered image.
  double mean_of(const std::string& scene, const std::string& samples) {
    const CommandResult result = run({"render", scene, "-o", "out.exr", "--spp", samples});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    errors_ = result.err;
    const Image rendered = image("out.exr");
    double sum = 0;
    const auto& green = rendered.planes.at(static_cast<size_t>(rendered.channel("G")));
    for (const float value : green) sum += static_cast<double>(value);
    return sum / static_cast<double>(green.size());
  }

  std::string errors_;  ///< stderr of the last render
};

/// The alpha of an RGBA image cuts holes into a black square, through which the sky is visible.
TEST_F(PbrtScenes, AlphaOfAnImageCutsOut) {
  const auto sky_through = [&](const Bytes& image_bytes, const std::string& name, const std::string& use) {
    folder_.write(name, image_bytes);
    folder_.write_text("leaf.pbrt", R"(Camera "orthographic" Film "rgb" "integer xresolution" 4 "integer yresolution" 4
WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
Texture "t" "float" "imagemap" "string filename" ")" +
                                        name + R"(" "string filter" "point"
Texture "half" "float" "scale" "texture tex" "t" "float scale" 0.5
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "trianglemesh" "point3 P" [ -2 -2 1  2 -2 1  2 2 1  -2 2 1 ] "integer indices" [ 0 1 2 0 2 3 ]
  "point2 uv" [ 0 0 1 0 1 1 0 1 ] "texture alpha" ")" +
                                        use + "\"");
    return mean_of("leaf.pbrt", "256");
  };
  // White, with one texel in four opaque, and the same with 16 bits; a mask without alpha.
  const Bytes leaf = png(2, 2, 8, 6, {0, 255, 255, 255, 0, 255, 255, 255, 0, 0, 255, 255, 255, 255, 255, 255, 255, 0});
  EXPECT_NEAR(sky_through(leaf, "leaf.png", "t"), 0.75, 0.02);
  EXPECT_NEAR(sky_through(leaf, "leaf.png", "half"), 0.875, 0.02);
  EXPECT_NEAR(sky_through(png(1, 1, 16, 4, {0, 255, 255, 0x33, 0x33}), "grey.png", "t"), 0.8, 0.02);
  EXPECT_NEAR(sky_through(png(2, 1, 8, 6, {0, 0, 0, 0, 255, 255, 255, 255, 255}), "mask.png", "t"), 0.5, 0.02);
  EXPECT_NEAR(sky_through(tga(2, 2, 1, 32, 0x28, {255, 255, 255, 0, 255, 255, 255, 51}), "leaf.tga", "t"), 0.9, 0.02);
}

/// A mesh that moves within an object, and one that moves in the world at the same position, give the same image.
TEST_F(PbrtScenes, MeshesMoveWithinObjects) {
  const std::string head = R"(Camera "orthographic" "float shutterclose" 1 Film "rgb" "integer xresolution" 16
"integer yresolution" 16 WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
)";
  const std::string moving = R"(AttributeBegin ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All
Shape "trianglemesh" "point3 P" [ -.2 -.2 1  .2 -.2 1  0 .2 1 ] "integer indices" [ 0 1 2 ] AttributeEnd
)";
  folder_.write_text("object.pbrt", head + "ObjectBegin \"o\"\n" + moving +
                                        "ObjectEnd\nTranslate -.5 .4 0 ObjectInstance \"o\"\nScale 1 -1 1 Translate 0 "
                                        ".8 0 ObjectInstance \"o\"");
  folder_.write_text("world.pbrt", head + "Translate -.5 .4 0\n" + moving + "Scale 1 -1 1 Translate 0 .8 0\n" + moving);
  const double mean = mean_of("world.pbrt", "16");
  const Image expected = image("out.exr");
  EXPECT_EQ(mean_of("object.pbrt", "16"), mean);
  EXPECT_EQ(errors_.find("warning"), std::string::npos) << errors_;
  EXPECT_EQ(image("out.exr").planes, expected.planes);
  EXPECT_LT(mean, 0.99);
}

}  // namespace

}  // namespace alhazen::impl::test
