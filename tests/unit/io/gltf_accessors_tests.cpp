// Accessors of glTF files: component types, normalized integers, strides, sparse values, bounds.

#include "io/read_scene.h"
#include "support/temporary_folder.h"
#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {

namespace {

/// A file of the triangle whose positions are `accessor`.
ParsedGltf with_positions(GltfFile& file, int accessor) {
  json primitive;
  primitive["attributes"]["POSITION"] = accessor;
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  return file.parse();
}

template <class T>
void expect_positions(const std::vector<T>& values, bool normalized, const Vec3d& second) {
  GltfFile file;
  const ParsedGltf parsed = with_positions(file, file.accessor<T>(values, "VEC3", normalized));
  ASSERT_EQ(parsed.mesh().positions.size(), 3u);
  expect_point(parsed.mesh().positions[1], second);
}

TEST(GltfAccessors, ReadEveryComponentType) {
  expect_positions<float>({0, 0, 0, 1.5f, 2, -3, 0, 1, 0}, false, {1.5, 2, -3});
  expect_positions<int8_t>({0, 0, 0, 10, 20, -30, 0, 1, 0}, false, {10, 20, -30});
  expect_positions<uint8_t>({0, 0, 0, 10, 20, 200, 0, 1, 0}, false, {10, 20, 200});
  expect_positions<int16_t>({0, 0, 0, 1000, 2000, -3000, 0, 1, 0}, false, {1000, 2000, -3000});
  expect_positions<uint16_t>({0, 0, 0, 1000, 2000, 60000, 0, 1, 0}, false, {1000, 2000, 60000});
}

TEST(GltfAccessors, NormalizeIntegersAsTheSpecificationSays) {
  expect_positions<int8_t>({0, 0, 0, 127, -127, -128, 0, 1, 0}, true, {1, -1, -1});
  expect_positions<uint8_t>({0, 0, 0, 255, 51, 0, 0, 1, 0}, true, {1, 0.2, 0});
  expect_positions<int16_t>({0, 0, 0, 32767, -32768, 0, 0, 1, 0}, true, {1, -1, 0});
  expect_positions<uint16_t>({0, 0, 0, 65535, 13107, 0, 0, 1, 0}, true, {1, 0.2, 0});
}

TEST(GltfAccessors, ReadIndicesOfEveryType) {
  const auto indices_of = [](int accessor, GltfFile& file) {
    json primitive = file.triangle();
    primitive["indices"] = accessor;
    file.add_node({{"mesh", file.add_mesh(primitive)}});
    return file.parse().mesh().indices;
  };
  const std::vector<uint32_t> expected{2, 0, 1};
  GltfFile bytes, shorts, ints;
  EXPECT_EQ(indices_of(bytes.accessor<uint8_t>({2, 0, 1}, "SCALAR"), bytes), expected);
  EXPECT_EQ(indices_of(shorts.accessor<uint16_t>({2, 0, 1}, "SCALAR"), shorts), expected);
  EXPECT_EQ(indices_of(ints.accessor<uint32_t>({2, 0, 1}, "SCALAR"), ints), expected);
}

TEST(GltfAccessors, FollowStrideAndOffset) {
  GltfFile file;
  // Interleaved positions and normals, from byte 4 on.
  const int view = file.view<float>({9, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1}, 24);
  json description{{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"byteOffset", 4}};
  const int positions = file.add_accessor(description);
  description["byteOffset"] = 16;
  const int normals = file.add_accessor(description);
  json primitive;
  primitive["attributes"] = {{"POSITION", positions}, {"NORMAL", normals}};
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const ParsedGltf parsed = file.parse();
  expect_point(parsed.mesh().positions[1], {2, 0, 0});
  expect_point(parsed.mesh().positions[2], {0, 2, 0});
  EXPECT_EQ(parsed.mesh().normals[2], (Vec3f{0, 0, 1}));
}

TEST(GltfAccessors, ReplaceSparseValues) {
  GltfFile file;
  const int base = file.view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = file.view<uint16_t>({1});
  const int values = file.view<float>({5, 6, 7});
  const json sparse{{"count", 1},
                    {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                    {"values", {{"bufferView", values}}}};
  const ParsedGltf parsed = with_positions(
      file, file.add_accessor(
                {{"bufferView", base}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}}));
  expect_point(parsed.mesh().positions[1], {5, 6, 7});
  expect_point(parsed.mesh().positions[2], {0, 1, 0});
}

TEST(GltfAccessors, StartSparseValuesFromZeroWithoutAView) {
  GltfFile file;
  const int indices = file.view<uint8_t>({1, 2});
  const int values = file.view<float>({1, 0, 0, 0, 1, 0});
  const json sparse{{"count", 2},
                    {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                    {"values", {{"bufferView", values}}}};
  const ParsedGltf parsed = with_positions(
      file, file.add_accessor({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}}));
  expect_point(parsed.mesh().positions[0], {0, 0, 0});
  expect_point(parsed.mesh().positions[2], {0, 1, 0});
}

TEST(GltfAccessors, RefuseWhatDoesNotFitIntoTheView) {
  GltfFile file;
  const int view = file.view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  json primitive;
  primitive["attributes"]["POSITION"] =
      file.add_accessor({{"bufferView", view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  EXPECT_NE(file.error().find("do not fit into its buffer view of 36 bytes"), std::string::npos) << file.error();
  file.root["accessors"][0]["count"] = 9007199254740992.0;
  EXPECT_NE(file.error().find("do not fit"), std::string::npos) << file.error();
  file.root["accessors"][0]["count"] = 3;
  file.root["accessors"][0]["byteOffset"] = 9007199254740992.0;
  EXPECT_NE(file.error().find("do not fit"), std::string::npos) << file.error();
}

TEST(GltfAccessors, RefuseValuesThatAreNotFinite) {
  GltfFile file;
  json primitive;
  primitive["attributes"]["POSITION"] =
      file.accessor<float>({0, 0, 0, std::numeric_limits<float>::infinity(), 0, 0, 0, 1, 0}, "VEC3");
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  EXPECT_NE(file.error().find("element 1 of the accessor is infinite or not a number"), std::string::npos);
}

TEST(GltfAccessors, RefuseTheWrongTypeAndSayWhere) {
  GltfFile file;
  json primitive;
  primitive["attributes"]["POSITION"] = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const std::string text = file.text();
  const size_t line = 1 + static_cast<size_t>(std::count(
                              text.begin(), text.begin() + static_cast<ptrdiff_t>(text.find("\"accessors\"")), '\n'));
  EXPECT_NE(error_of_gltf(text).find("test.gltf:" + std::to_string(line + 1) + ":3: "), std::string::npos)
      << error_of_gltf(text);
  EXPECT_NE(error_of_gltf(text).find("VEC3"), std::string::npos);
}

TEST(GltfAccessors, ReadBinaryFilesAndFilesBesideThem) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const ParsedGltf binary = parse_text(file.glb());
  expect_point(binary.mesh().positions[1], {1, 0, 0});

  const TemporaryFolder folder;
  folder.write("a buffer%.bin", file.data);
  file.root["buffers"] = json::array({{{"byteLength", file.data.size()}, {"uri", "a%20buffer%25.bin"}}});
  const ParsedGltf beside = parse_text(file.root.dump(), {}, folder.path());
  expect_point(beside.mesh().positions[1], {1, 0, 0});
  file.root["buffers"][0]["uri"] = "missing.bin";
  EXPECT_NE(error_of_gltf(file.root.dump(), {}, folder.path()).find("'missing.bin' does not exist"), std::string::npos);
  file.root["buffers"][0]["uri"] = "http://example.org/a.bin";
  EXPECT_NE(error_of_gltf(file.root.dump(), {}, folder.path()).find("is not a file"), std::string::npos);
}

TEST(GltfAccessors, KnowBinaryFilesByTheirFirstBytes) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const TemporaryFolder folder;
  Diagnostics diagnostics;
  EXPECT_EQ(read_scene(folder.write_text("scene.of-no-name", file.glb()), diagnostics).meshes.size(), 1u);
}

}  // namespace

}  // namespace alhazen::impl::test
