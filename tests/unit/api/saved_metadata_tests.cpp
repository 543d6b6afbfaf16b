// Images that are rendered into memory and saved have the headers of those that the program writes.

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "alhazen/renderer.h"
#include "alhazen/save.h"
#include "pipeline/load_scene.h"
#include "pipeline/write_outputs.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

/// The attributes of an EXR file by name, as bytes of the file, but for the time that the render took.
std::map<std::string, std::string> exr_attributes(const std::string& path) {
  const Imf::InputFile file(path.c_str());
  std::map<std::string, std::string> attributes;
  for (Imf::Header::ConstIterator i = file.header().begin(); i != file.header().end(); ++i) {
    Imf::StdOSStream bytes;
    i.attribute().writeValueTo(bytes, 2);
    attributes[i.name()] = std::string(i.attribute().typeName()) + " " + bytes.str();
  }
  EXPECT_EQ(attributes.erase("seconds"), 1u);
  return attributes;
}

uint32_t big_endian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes.at(at + i));
  return value;
}

/// The texts of a PNG file by keyword.
std::map<std::string, std::string> png_texts(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  const std::string bytes = content.str();
  std::map<std::string, std::string> texts;
  for (size_t at = 8; at < bytes.size();) {
    const uint32_t size = big_endian(bytes, at);
    const std::string kind = bytes.substr(at + 4, 4), data = bytes.substr(at + 8, size);
    if (kind == "tEXt" || kind == "zTXt" || kind == "iTXt") texts[data.substr(0, data.find('\0'))] = data;
    at += size_t{12} + size;
  }
  return texts;
}

/// Renders and writes as the program does.
void render_to_file(const std::string& scene, const Settings& settings, const std::string& path,
                    const impl::WriteOptions& how) {
  impl::Diagnostics diagnostics;
  impl::LoadedScene loaded = impl::load_scene(scene, settings, diagnostics);
  const impl::RenderSettings resolved = impl::resolve_settings(settings, loaded.scene);
  const impl::Rendering rendering =
      impl::render_scene(std::move(loaded.scene), resolved, loaded.seconds, {}, diagnostics);
  impl::OutputOptions options;
  options.paths = {path};
  options.how = how;
  const impl::OutputReport report = impl::write_outputs(options, rendering);
  ASSERT_EQ(report.written.size(), 1u) << (report.failures.empty() ? "" : report.failures[0]);
}

Settings many_layers() {
  Settings settings = quick_settings();
  settings.aovs = {"cryptomatte", "object", "material", "depth", "samples"};
  settings.pixel_bounds = {{3, 18, 2, 11}};
  settings.seed = 7;
  settings.noise = 0.5;
  settings.clamp_indirect = 3;
  settings.fov = 35;
  return settings;
}

}  // namespace

TEST_F(SceneTest, SavedImagesHaveTheHeadersOfTheProgram) {
  const std::string scene = folder_.write_text(
      "scene.pbrt", std::string(pbrt_view) + "WorldBegin\nMakeNamedMaterial \"clay\" \"string type\" \"diffuse\"\n" +
                        "NamedMaterial \"clay\"\n" + pbrt_floor + pbrt_lights + "Shape \"sphere\"\n");
  const RenderedImage image = render(scene, many_layers());
  const std::string own = folder_.file("own.exr"), programs = folder_.file("programs.exr");
  save(image, own);
  render_to_file(scene, many_layers(), programs, {});
  const std::map<std::string, std::string> attributes = exr_attributes(own);
  EXPECT_EQ(attributes, exr_attributes(programs));
  for (const char* const name : {"scene", "samples", "seed", "settings", "denoiser", "noise", "software", "object",
                                 "material", "dataWindow", "displayWindow"})
    EXPECT_EQ(attributes.count(name), 1u) << name;
  EXPECT_TRUE(std::any_of(attributes.begin(), attributes.end(),
                          [](const auto& attribute) { return attribute.first.ends_with("/manifest"); }));
  EXPECT_EQ(image.metadata.at("scene"), scene);
  EXPECT_EQ(image.metadata.at("seed"), "7");

  const std::string own_png = folder_.file("own.png"), programs_png = folder_.file("programs.png");
  save(image, own_png, {.exposure = 1, .tone_mapping = ToneMapping::filmic});
  impl::WriteOptions how;
  how.exposure = 1;
  how.tone_map = impl::ToneMap::filmic;
  render_to_file(scene, many_layers(), programs_png, how);
  const std::map<std::string, std::string> texts = png_texts(own_png);
  EXPECT_EQ(texts, png_texts(programs_png));
  EXPECT_GE(texts.size(), 6u);
  EXPECT_EQ(texts.count("display"), 1u);
  EXPECT_EQ(texts.count("object"), 0u) << "a PNG has no layers";
}

TEST_F(SceneTest, ImagesOfTheRendererHaveTheSameHeaders) {
  alhazen::Scene scene;
  add_floor(scene);
  add_lights(scene);
  Settings settings = quick_settings();
  settings.aovs = {"object"};
  Renderer renderer(settings);
  RenderedImage grown = renderer.render(scene), at_once = render(scene, settings);
  for (RenderedImage* image : {&grown, &at_once}) EXPECT_EQ(image->metadata.erase("seconds"), 1u);
  EXPECT_EQ(grown.metadata, at_once.metadata);
}

TEST_F(SceneTest, ImagesThatClaimAnImpossiblePlaceAreRefused) {
  RenderedImage image = render(alhazen::Scene(), quick_settings());
  for (const int x : {-1, 1}) {
    image.x = x;
    EXPECT_NE(error_of([&] { save(image, folder_.file("image.exr")); }).find("full_width"), std::string::npos);
  }
  image.full_width = image.full_height = 0;
  EXPECT_NO_THROW(save(image, folder_.file("image.exr")));
}

}  // namespace alhazen::test
