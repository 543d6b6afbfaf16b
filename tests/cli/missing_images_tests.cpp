// Texture images that are not there, and folders in which files are looked for.

#include "alhazen/alhazen.h"
#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

class MissingImages : public Command {
 protected:
  MissingImages() { folder_.write_text("s.pbrt", wall("colour.png", "roughness.png")); }

  /// A white sky seen through nothing, and a wall that fills the image.
  static std::string wall(const std::string& colour, const std::string& roughness) {
    return R"(Camera "perspective" Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
Texture "c" "spectrum" "imagemap" "bool invert" true "string filename" ")" +
           colour + R"("
Texture "r" "float" "imagemap" "string filename" ")" +
           roughness + R"("
Material "diffuse" "texture reflectance" "c" "texture roughness" "r"
Shape "trianglemesh" "point3 P" [ -9 -9 1  9 -9 1  9 9 1  -9 9 1 ] "integer indices" [ 0 1 2 0 2 3 ]
  "normal N" [ 0 0 -1 0 0 -1 0 0 -1 0 0 -1 ])";
  }

  void write_texture(const std::string& name, float green) const {
    Image picture{4, 4, {"R", "G", "B"}, std::vector(3, std::vector<float>(16, 0.0f))};
    picture.planes[1].assign(16, green);
    fs::create_directories(fs::path(folder_.file(name)).parent_path());
    write_png(folder_.file(name), source_of(picture), {});
  }

  CommandResult render_scene(const std::vector<std::string>& more, const std::string& scene = "s.pbrt") const {
    std::vector<std::string> arguments{"render", scene, "-o", "a.exr", "--spp", "4", "-q", "--max-depth", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  void expect_magenta() const {
    const Image image = this->image("a.exr");
    const auto at = [&](const char* channel) {
      return image.planes.at(static_cast<size_t>(image.channel(channel))).at(27);
    };
    EXPECT_GT(at("R"), 0.2f);
    EXPECT_GT(at("B"), 0.2f);
    EXPECT_LT(at("G"), 0.1f * at("R"));
  }
};

TEST_F(MissingImages, AreMagentaAndAllAreNamed) {
  const CommandResult result = render_scene({});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  ASSERT_EQ(lines_of(result.err).size(), 2u) << result.err;
  EXPECT_NE(result.err.find("warning: s.pbrt:3:"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("colour.png\" (looked for colour.png): magenta"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("roughness.png\" (looked for roughness.png): the float texture is 1"), std::string::npos)
      << result.err;
  expect_magenta();
}

TEST_F(MissingImages, AreErrorsIfStrict) {
  folder_.write_text("a.exr", "as it was");
  const CommandResult result = render_scene({"--strict"});
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_NE(result.err.find("s.pbrt:3:"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("there is no file \"colour.png\""), std::string::npos) << result.err;
  EXPECT_EQ(read_file(folder_.file("a.exr")).size(), 9u);
  EXPECT_EQ(run({"info", "s.pbrt", "--strict"}).exit_code, 2);
  EXPECT_EQ(run({"info", "s.pbrt"}).exit_code, 0);
}

TEST_F(MissingImages, OfAnyOtherKindAreErrors) {
  folder_.write_text("colour.png", "no image");
  EXPECT_EQ(render_scene({}).exit_code, 2) << "an image that is there and malformed";
  fs::remove(folder_.file("colour.png"));
  fs::create_directory(folder_.file("colour.png"));
  EXPECT_EQ(render_scene({}).exit_code, 2) << "a folder";
  for (const char* light : {"infinite", "projection", "goniometric"}) {
    folder_.write_text("light.pbrt", std::string("WorldBegin LightSource \"") + light +
                                         "\" \"string filename\" \"no.exr\" Shape \"sphere\"");
    const CommandResult result = render_scene({}, "light.pbrt");
    EXPECT_EQ(result.exit_code, 2) << light;
    EXPECT_NE(result.err.find("light.pbrt:1:"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("--search-path"), std::string::npos) << result.err;
  }
  const CommandResult map = run({"render", "scene.pbrt", "-o", "b.exr", "--environment", "no.exr"});
  EXPECT_EQ(map.exit_code, 2) << map.everything();
  EXPECT_FALSE(exists("b.exr"));
}

/// The path of the scene below a folder, and the last part of it; absolute paths and those of Windows, too.
TEST_F(MissingImages, AreFoundInFurtherFolders) {
  write_texture("far/one/colour.png", 0);
  write_texture("far/two/sub/roughness.png", 1);
  for (const std::string& colour : {std::string("colour.png"), std::string("deep/colour.png"),
                                    std::string("/no/such/colour.png"), std::string("C:\\\\maps\\\\colour.png")}) {
    folder_.write_text("s.pbrt", wall(colour, "sub/roughness.png"));
    for (const auto& options : {std::vector<std::string>{"--search-path", "far/one", "--search-path", "far/two"},
                                std::vector<std::string>{"--search-path", "far/one:far/two"}}) {
      const CommandResult result = render_scene(options);
      EXPECT_EQ(result.exit_code, 0) << result.everything();
      EXPECT_EQ(result.err, "") << colour;
    }
  }
  const CommandResult none = render_scene({"--search-path", "nowhere"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--search-path 'nowhere'"), std::string::npos) << none.err;
  EXPECT_EQ(render_scene({"--search-path", "far/one::far/two"}).exit_code, 2);
}

TEST_F(MissingImages, TheScenesOwnFolderComesFirst) {
  write_texture("in/colour.png", 0);
  write_texture("in/roughness.png", 0);
  write_texture("other/colour.png", 1);
  folder_.write_text("in/s.pbrt", wall("colour.png", "roughness.png"));
  ASSERT_EQ(render_scene({"--search-path", "other"}, "in/s.pbrt").exit_code, 0);
  const Image own = image("a.exr");
  ASSERT_EQ(render_scene({}, "in/s.pbrt").exit_code, 0);
  EXPECT_EQ(own.planes, image("a.exr").planes);
}

TEST_F(MissingImages, FurtherFoldersAreWithinAConfinement) {
  write_texture("in/maps/colour.png", 0);
  write_texture("out/colour.png", 0);
  write_texture("in/maps/roughness.png", 0);
  folder_.write_text("in/s.pbrt", wall("colour.png", "roughness.png"));
  EXPECT_EQ(render_scene({"--confine", "--search-path", "in/maps"}, "in/s.pbrt").err, "");
  const CommandResult outside = render_scene({"--confine", "--search-path", "out"}, "in/s.pbrt");
  EXPECT_EQ(outside.exit_code, 2);
  EXPECT_NE(outside.err.find("is outside the scene's folder"), std::string::npos) << outside.err;
}

TEST_F(MissingImages, OfGltf) {
  const auto scene = [](const std::string& uri) {
    return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
 "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
  "normalTexture": {"index": 1}, "doubleSided": true}], "textures": [{"source": 0}, {"source": 1}],
 "images": [{"uri": ")" +
           uri + R"("}, {"uri": "normals.png"}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  };
  folder_.write_text("s.gltf", scene("base%20colour.png"));
  const CommandResult result = render_scene({"--size", "8x8"}, "s.gltf");
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  ASSERT_EQ(lines_of(result.err).size(), 2u) << result.err;
  EXPECT_NE(result.err.find("s.gltf:5:"), std::string::npos) << result.err;
  for (const char* name : {"'base%20colour.png'", "'normals.png'"})
    EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
  EXPECT_EQ(render_scene({"--strict"}, "s.gltf").exit_code, 2);
  write_texture("maps/base colour.png", 0);
  write_texture("maps/normals.png", 0);
  const CommandResult found = render_scene({"--size", "8x8", "--search-path", "maps"}, "s.gltf");
  EXPECT_EQ(found.exit_code, 0) << found.everything();
  EXPECT_EQ(found.err, "");
}

TEST_F(MissingImages, OfTheLibrary) {
  Settings settings;
  settings.samples_per_pixel = 1;
  const std::string scene = folder_.file("s.pbrt");
  EXPECT_EQ(alhazen::render(scene, settings).warnings.size(), 2u);
  settings.strict = true;
  EXPECT_THROW(alhazen::render(scene, settings), std::runtime_error);
  write_texture("maps/colour.png", 0);
  write_texture("maps/roughness.png", 0);
  settings.search_paths = {folder_.file("maps")};
  EXPECT_TRUE(alhazen::render(scene, settings).warnings.empty());
}

}  // namespace

}  // namespace alhazen::impl::test
