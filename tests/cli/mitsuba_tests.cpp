// Mitsuba scenes and models of OBJ, STL and PLY on the command line.

#include <algorithm>
#include <cmath>

#include "cli/fixture.h"
#include "io/mitsuba/xml.h"

namespace alhazen::impl::test {

namespace {

/// A lamp and a point light over glass and metal on a floor.
const char* const mitsuba_scene = R"(<scene version="3.0.0">
  <default name="spp" value="64"/>
  <integrator type="path"><integer name="max_depth" value="5"/></integrator>
  <sensor type="perspective">
    <transform name="to_world"><lookat origin="0, 1.5, 6" target="0, 0.8, 0" up="0, 1, 0"/></transform>
    <float name="fov" value="35"/><string name="fov_axis" value="smaller"/>
    <film type="hdrfilm"><integer name="width" value="48"/><integer name="height" value="32"/><rfilter type="box"/></film>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="0.1, 0.15, 0.2"/></emitter>
  <emitter type="point"><point name="position" x="2" y="4" z="3"/><rgb name="intensity" value="20, 18, 15"/></emitter>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate x="-1" y="3"/></transform>
    <bsdf type="diffuse"/>
    <emitter type="area"><rgb name="radiance" value="8, 6, 4"/></emitter>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale x="5" y="5"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.4, 0.6, 0.3"/></bsdf></bsdf>
  </shape>
  <shape type="sphere"><point name="center" x="1" y="0.8" z="1"/><float name="radius" value="0.8"/>
    <bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>
  </shape>
  <shape type="sphere"><point name="center" x="-1" y="0.8" z="0"/><float name="radius" value="0.8"/>
    <bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha" value="0.2"/>
      <rgb name="eta" value="0.2, 0.9, 1.1"/><rgb name="k" value="3.9, 2.4, 2.2"/></bsdf>
  </shape>
</scene>)";

/// The same.
const char* const pbrt_scene = R"(LookAt 0 1.5 6  0 0.8 0  0 1 0 Scale -1 1 1
Camera "perspective" "float fov" 35
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Sampler "sobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.15 0.2 ]
LightSource "point" "point3 from" [ 2 4 3 ] "rgb I" [ 20 18 15 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 8 6 4 ]
  Translate -1 3 0 Rotate 90 1 0 0
  Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
  Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0.4 0.6 0.3 ]
  Rotate -90 1 0 0 Scale 5 5 1
  Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
AttributeBegin Material "dielectric" "float eta" 1.5
  Translate 1 0.8 1 Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
  Material "conductor" "rgb eta" [ 0.2 0.9 1.1 ] "rgb k" [ 3.9 2.4 2.2 ] "float roughness" 0.2 "bool remaproughness" false
  Translate -1 0.8 0 Shape "sphere" "float radius" 0.8
AttributeEnd)";

class Formats : public Command {
 protected:
  /// The mean of each channel of what a file gives, rendered small.
  std::array<double, 3> means(const std::string& file) {
    const CommandResult result = run({"render", file, "-o", "out.exr", "--size", "24x24", "--spp", "4", "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    const Image rendered = image("out.exr");
    std::array<double, 3> sums{};
    for (size_t channel = 0; channel < 3; ++channel)
      for (const float value :
           rendered.planes.at(static_cast<size_t>(rendered.channel(std::string(1, "RGB"[channel])))))
        sums[channel] += static_cast<double>(value) / (24 * 24);
    return sums;
  }
};

class MitsubaScenes : public Formats {
 protected:
  void SetUp() override {
    if (!mitsuba::reads_xml()) GTEST_SKIP() << "this build has no Expat";
    folder_.write_text("scene.xml", mitsuba_scene);
  }
};

TEST_F(MitsubaScenes, GiveTheImageOfTheSameSceneInPbrt) {
  folder_.write_text("scene.pbrt", pbrt_scene);
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "--exr-type", "float", "-q"}).exit_code, 0);
  ASSERT_EQ(run({"render", "scene.pbrt", "-o", "b.exr", "--exr-type", "float", "-q"}).exit_code, 0);
  const Image a = image("a.exr"), b = image("b.exr");
  ASSERT_EQ(a.width, b.width);
  double difference = 0, sum = 0;
  for (const char* const channel : {"R", "G", "B"}) {
    const auto& ours = a.planes.at(static_cast<size_t>(a.channel(channel)));
    const auto& theirs = b.planes.at(static_cast<size_t>(b.channel(channel)));
    for (size_t i = 0; i < ours.size(); ++i) {
      difference += std::abs(static_cast<double>(ours[i]) - static_cast<double>(theirs[i]));
      sum += static_cast<double>(theirs[i]);
    }
  }
  EXPECT_GT(sum, 100);
  EXPECT_LT(difference, 1e-3 * sum);
}

TEST_F(MitsubaScenes, TakeDefinitions) {
  const auto samples = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"info", "scene.xml", "--json"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return only_json(result.out).value("spp", 0);
  };
  EXPECT_EQ(samples({}), 64);
  EXPECT_EQ(samples({"-D", "spp=5"}), 5);
  EXPECT_EQ(samples({"--define", "spp=6"}), 6);
  ASSERT_EQ(run({"render", "scene.xml", "-D", "spp=2", "-o", "out.exr", "-q"}).exit_code, 0);
  const CommandResult unused = run({"render", "scene.xml", "-D", "size=2", "-o", "none.exr"});
  EXPECT_EQ(unused.exit_code, 2);
  EXPECT_NE(unused.err.find("the scene has no '$size', which a definition gives a value"), std::string::npos)
      << unused.err;
  const CommandResult malformed = run({"render", "scene.xml", "-D", "spp", "-o", "none.exr"});
  EXPECT_EQ(malformed.exit_code, 2);
  EXPECT_NE(malformed.err.find("NAME=VALUE, for example spp=64"), std::string::npos) << malformed.err;
  folder_.write_text("scene.pbrt", pbrt_scene);
  const CommandResult other = run({"render", "scene.pbrt", "-D", "spp=2", "-o", "none.exr"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("parameters can be defined (-D) for Mitsuba scenes only"), std::string::npos) << other.err;
  EXPECT_FALSE(exists("none.exr"));
}

TEST_F(MitsubaScenes, AreConfinedToTheirFolder) {
  std::filesystem::create_directories(folder_.file("inner"));
  folder_.write_text("outer.xml", "<scene version=\"3.0.0\"/>");
  folder_.write_text("inner/scene.xml", "<scene version=\"3.0.0\"><include filename=\"../outer.xml\"/></scene>");
  EXPECT_EQ(run({"info", "inner/scene.xml"}).exit_code, 0);
  const CommandResult confined = run({"info", "inner/scene.xml", "--confine"});
  EXPECT_EQ(confined.exit_code, 2);
  EXPECT_NE(confined.err.find("inner/scene.xml:1:24: the file \"../outer.xml\" is outside the scene's folder"),
            std::string::npos)
      << confined.err;
}

TEST_F(MitsubaScenes, WithErrorsLeaveTheOutputAlone) {
  folder_.write_text("bad.xml", "<scene version=\"3.0.0\">\n<shape type=\"cone\"/></scene>");
  folder_.write_text("out.exr", "precious");
  const CommandResult result = run({"render", "bad.xml", "-o", "out.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("bad.xml:2:1: unknown shape 'cone'"), std::string::npos) << result.err;
  EXPECT_EQ(std::filesystem::file_size(folder_.file("out.exr")), 8u);
}

TEST_F(Formats, ObjIsShownWithItsMaterials) {
  folder_.write_text("m.mtl", "newmtl red\nKd 0.8 0.02 0.02\n");
  folder_.write_text("m.obj", "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl red\nf 1 2 3 4\n");
  const auto [red, green, blue] = means("m.obj");
  folder_.write_text("plain.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
  const auto [grey, grey_green, grey_blue] = means("plain.obj");
  EXPECT_LT(green / red, 0.7 * grey_green / grey);
  EXPECT_LT(blue / red, 0.7 * grey_blue / grey);
  const CommandResult info = run({"info", "m.obj"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("2 triangles"), std::string::npos) << info.out;
}

TEST_F(Formats, StlAndPlyAreShown) {
  folder_.write_text("m.stl",
                     "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
                     "endfacet\nendsolid\n");
  EXPECT_GT(means("m.stl")[0], 0.01);
  folder_.write_text("m.ply",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
                     "property list uchar int vertex_indices\nend_header\n-1 -1 0 0 255 0\n1 -1 0 0 255 0\n"
                     "0 1 0 0 255 0\n3 0 1 2\n");
  const auto [red, green, blue] = means("m.ply");
  EXPECT_GT(green, red);
  EXPECT_GT(green, blue);
  for (const char* const file : {"m.stl", "m.ply"}) EXPECT_EQ(run({"info", file}).exit_code, 0);
}

}  // namespace

}  // namespace alhazen::impl::test
