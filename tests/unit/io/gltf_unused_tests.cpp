// Parts of glTF files that nothing draws: their structure must be right, their data are not read.

#include <functional>
#include <limits>

#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {

namespace {

/// A triangle that is drawn.
GltfFile drawn_triangle() {
  GltfFile file;
  const int positions = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  file.add_mesh({{"attributes", {{"POSITION", positions}}}});
  file.root["nodes"] = json::array({{{"mesh", 0}}});
  file.root["scenes"] = json::array({{{"nodes", {0}}}});
  return file;
}

std::string text_of(GltfFile file) {
  file.root["buffers"] =
      json::array({{{"byteLength", file.data.size()}, {"uri", "data:;base64," + base64(file.data)}}});
  return file.root.dump();
}

std::string error_with(const std::function<void(GltfFile&)>& change) {
  GltfFile file = drawn_triangle();
  change(file);
  return error_of_gltf(text_of(file));
}

TEST(GltfUnused, ReferencesThatLeadNowhereAreErrors) {
  const auto texture_by = [](const char* extension) {
    return [extension](GltfFile& f) {
      f.root["textures"] = json::array({{{"extensions", {{extension, {{"source", 3}}}}}}});
    };
  };
  for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"})
    EXPECT_NE(error_with(texture_by(extension)).find("\"images\" has 0 items"), std::string::npos) << extension;
  const auto light = [](GltfFile& f) {
    f.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  };
  EXPECT_NE(error_with(light).find("\"lights\" has 0 items"), std::string::npos);
  const auto variant = [](GltfFile& f) {
    f.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] =
        json::array({{{"variants", {2}}, {"material", 0}}});
    f.root["materials"] = json::array({json::object()});
  };
  EXPECT_NE(error_with(variant).find("\"variants\" has 0 items"), std::string::npos);
  EXPECT_EQ(error_with([](GltfFile&) {}), "");
}

TEST(GltfUnused, AccessorsMustFitIntoTheirViews) {
  const auto with = [](json changes) {
    return error_with([changes](GltfFile& f) {
      const int view = f.view(std::vector<float>(6));
      json accessor{{"bufferView", view}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}};
      accessor.update(changes);
      f.add_accessor(accessor);
    });
  };
  EXPECT_EQ(with(json::object()), "");
  EXPECT_NE(with({{"count", 3}}).find("do not fit"), std::string::npos);
  EXPECT_NE(with({{"byteOffset", 4}}).find("do not fit"), std::string::npos);
  EXPECT_NE(with({{"byteOffset", 9007199254740991}}).find("do not fit"), std::string::npos);
  EXPECT_NE(with({{"count", 9007199254740991}}).find("do not fit"), std::string::npos);
  EXPECT_NE(with({{"type", "VEC9"}}).find("unknown \"type\""), std::string::npos);
  EXPECT_NE(with({{"componentType", 7}}).find("unknown \"componentType\""), std::string::npos);
  const json sparse{
      {"count", 3}, {"indices", {{"bufferView", 0}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
  EXPECT_NE(with({{"sparse", sparse}}).find("at most all of them"), std::string::npos);
}

TEST(GltfUnused, DataAreNotRead) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto add_mesh = [&](GltfFile& f) {
    f.add_mesh({{"attributes", {{"POSITION", f.accessor(std::vector<float>(9, nan), "VEC3")}}}});
  };
  EXPECT_EQ(error_with(add_mesh), "");
  const auto draw = [&](GltfFile& f) {
    add_mesh(f);
    f.root["nodes"][0]["mesh"] = 1;
  };
  EXPECT_NE(error_with(draw).find("infinite or not a number"), std::string::npos);
  EXPECT_EQ(error_with([](GltfFile& f) { f.root["images"] = json::array({{{"uri", "no.png"}}}); }), "");
}

/// As `named_objects` of the validator of glTF: valid, and nothing that can be seen.
TEST(GltfUnused, ABufferWithoutDataIsZeros) {
  GltfFile file = drawn_triangle();
  file.root["buffers"] = json::array({{{"byteLength", file.data.size()}}});
  const ParsedGltf parsed = parse_text(file.root.dump());
  EXPECT_TRUE(parsed.warned("the buffer has no data"));
  EXPECT_EQ(length(parsed.mesh().positions.at(1)), 0);
  file.root["buffers"][0]["byteLength"] = uint64_t{1} << 40;
  EXPECT_NE(error_of_gltf(file.root.dump()).find("needs a \"uri\""), std::string::npos);
}

}  // namespace

}  // namespace alhazen::impl::test
