// Meshes of glTF files: modes, attributes, nodes, instances, morph targets, skins, animations.

#include <numbers>

#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {

namespace {

std::vector<uint32_t> indices_of_mode(int mode, bool indexed) {
  GltfFile file;
  json primitive;
  primitive["attributes"]["POSITION"] = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  if (indexed) primitive["indices"] = file.accessor<uint8_t>({4, 3, 2, 1, 0}, "SCALAR");
  primitive["mode"] = mode;
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  return file.parse().mesh().indices;
}

TEST(GltfMeshes, TurnStripsAndFansIntoTriangles) {
  EXPECT_EQ(indices_of_mode(5, false), (std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(indices_of_mode(5, true), (std::vector<uint32_t>{4, 3, 2, 3, 1, 2, 2, 1, 0}));
  EXPECT_EQ(indices_of_mode(6, false), (std::vector<uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
  EXPECT_EQ(indices_of_mode(6, true), (std::vector<uint32_t>{3, 2, 4, 2, 1, 4, 1, 0, 4}));
}

TEST(GltfMeshes, DropLeftOverVerticesWithAWarning) {
  GltfFile file;
  json primitive;
  primitive["attributes"]["POSITION"] = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const ParsedGltf parsed = file.parse();
  EXPECT_EQ(parsed.mesh().indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(parsed.warned("not a multiple of 3"));
}

TEST(GltfMeshes, SkipPointsAndLinesWithOneWarning) {
  GltfFile file;
  json primitive = file.triangle();
  for (const int mode : {0, 1, 2, 3}) {
    primitive["mode"] = mode;
    file.add_node({{"mesh", file.add_mesh(primitive)}});
  }
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const ParsedGltf parsed = file.parse();
  EXPECT_EQ(parsed.shapes().size(), 1u);
  EXPECT_EQ(parsed.diagnostics.warnings().size(), 1u);
  primitive["mode"] = 7;
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  EXPECT_NE(file.error().find("unknown \"mode\" 7"), std::string::npos);
}

TEST(GltfMeshes, ReadNormalsTangentsUvsAndColours) {
  GltfFile file;
  json primitive = file.triangle();
  auto& attributes = primitive["attributes"];
  attributes["NORMAL"] = file.accessor<float>({0, 0, 2, 0, 0, 1, 0, 0, 1}, "VEC3");
  attributes["TANGENT"] = file.accessor<float>({1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  attributes["TEXCOORD_1"] = file.accessor<uint8_t>({0, 0, 255, 51, 0, 0}, "VEC2", true);
  attributes["COLOR_0"] = file.accessor<uint8_t>({255, 51, 0, 0, 0, 0, 0, 0, 0}, "VEC3", true);
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  const ParsedGltf parsed = file.parse();
  const Mesh& mesh = parsed.mesh();
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_EQ(mesh.tangents[0], (std::array<float, 4>{1, 0, 0, -1}));
  // v points down in the file, and up here.
  EXPECT_EQ(mesh.uvs[0], (Vec2f{0, 0}));
  EXPECT_EQ(mesh.uvs[2], (Vec2f{0, 1}));
  EXPECT_NEAR(mesh.second_uvs[1].y, 0.8, 1e-6);
  EXPECT_NEAR(mesh.colours[0][1], 0.2, 1e-6);
  EXPECT_EQ(mesh.colours[0][3], 1);
  const uint32_t base = parsed.material().principled.base_colour;
  EXPECT_EQ(parsed.texture(base).kind, TextureKind::vertex_colour);
}

TEST(GltfMeshes, LeaveTangentsOutWhereThereAreNoNormals) {
  GltfFile file;
  json primitive = file.triangle();
  primitive["attributes"]["TANGENT"] = file.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  EXPECT_TRUE(file.parse().mesh().normals.empty());
  EXPECT_TRUE(file.parse().mesh().tangents.empty());
}

TEST(GltfMeshes, ChainTransformsOfNodes) {
  GltfFile file;
  const double half = std::numbers::sqrt2 / 2;
  // A rotation by 90 degrees about z, then a matrix that scales by two and translates, given by columns.
  file.root["nodes"] = {
      {{"children", {1}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1}}},
      {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"translation", {0, 1, 0}}, {"scale", {3, 1, -1}}}};
  file.add_mesh(file.triangle());
  const ParsedGltf parsed = file.parse();
  const Transform& world = parsed.shapes()[0].world_from_object.start;
  // (1, 0, 1) scaled (3, 0, -1), rotated (0, 3, -1), translated (0, 4, -1), then scaled and translated.
  expect_point(world.point({1, 0, 1}), {10, 8, -2});
  EXPECT_TRUE(world.swaps_handedness());
}

TEST(GltfMeshes, DrawNodesThatAreScaledFlat) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}, {"scale", {1, 1, 0}}, {"translation", {0, 0, 5}}});
  const ParsedGltf parsed = file.parse();
  expect_point(parsed.mesh().positions[1], {1, 0, 5});
  EXPECT_TRUE(parsed.shapes()[0].world_from_object.start.is_identity());
}

TEST(GltfMeshes, MakeInstancesOfMeshesThatAreUsedTwice) {
  GltfFile file;
  const int mesh = file.add_mesh(file.triangle());
  file.add_node({{"mesh", mesh}});
  file.add_node({{"mesh", mesh}, {"translation", {0, 0, 7}}});
  const ParsedGltf parsed = file.parse();
  EXPECT_TRUE(parsed.shapes().empty());
  ASSERT_EQ(parsed.scene.groups.size(), 2u);
  ASSERT_EQ(parsed.scene.instances.size(), 2u);
  EXPECT_EQ(parsed.scene.meshes.size(), 1u);
  expect_point(parsed.scene.instances[1].world_from_group.start.point({}), {0, 0, 7});
}

TEST(GltfMeshes, PlaceEmissiveMeshesDirectly) {
  GltfFile file;
  file.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
  json primitive = file.triangle();
  primitive["material"] = 0;
  const int mesh = file.add_mesh(primitive);
  file.add_node({{"mesh", mesh}});
  file.add_node({{"mesh", mesh}, {"translation", {0, 0, 7}}});
  const ParsedGltf parsed = file.parse();
  EXPECT_EQ(parsed.shapes().size(), 2u);
  EXPECT_TRUE(parsed.scene.instances.empty());
  EXPECT_EQ(parsed.scene.meshes.size(), 1u);
}

TEST(GltfMeshes, ReadInstancesForGpus) {
  GltfFile file;
  const int translations = file.accessor<float>({0, 0, 0, 1, 2, 3}, "VEC3");
  const int rotations = file.accessor<int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, "VEC4", true);
  const int scales = file.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3");
  json node{{"mesh", file.add_mesh(file.triangle())}, {"translation", {10, 0, 0}}};
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}};
  file.add_node(node);
  const ParsedGltf parsed = file.parse();
  ASSERT_EQ(parsed.scene.instances.size(), 2u);
  // A rotation by 180 degrees about z.
  expect_point(parsed.scene.instances[1].world_from_group.start.point({1, 0, 0}), {9, 2, 3});
}

TEST(GltfMeshes, RefuseLoopsAndTwoParents) {
  GltfFile file;
  file.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  EXPECT_NE(file.error().find("is its own ancestor"), std::string::npos);
  file.root["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
  EXPECT_NE(file.error().find("child of two nodes"), std::string::npos);
}

TEST(GltfMeshes, StandDeepChainsOfNodes) {
  GltfFile file;
  const int mesh = file.add_mesh(file.triangle());
  for (int i = 0; i < 100'000; ++i) file.add_node({{"children", {i + 1}}});
  file.add_node({{"mesh", mesh}});
  EXPECT_EQ(file.parse().shapes().size(), 1u);
}

// Deformation -------------------------------------------------------------------------------------------------------

GltfFile morph_file() {
  GltfFile file;
  json primitive = file.triangle();
  json targets = json::array();
  targets.push_back({{"POSITION", file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}});
  targets.push_back({{"POSITION", file.accessor<float>({2, 0, 0, 2, 0, 0, 2, 0, 0}, "VEC3")}});
  primitive["targets"] = targets;
  file.add_mesh(primitive);
  file.root["meshes"][0]["weights"] = {0.5, 0};
  file.add_node({{"mesh", 0}});
  return file;
}

TEST(GltfMeshes, AddMorphTargetsByTheirWeights) {
  GltfFile file = morph_file();
  expect_point(file.parse().mesh().positions[1], {1, 0, 0.5});
  file.root["nodes"][0]["weights"] = {1, 0.25};
  expect_point(file.parse().mesh().positions[1], {1.5, 0, 1});
}

void animate(GltfFile& file, const std::string& path, const std::string& interpolation, int input, int output) {
  json animation;
  animation["name"] = interpolation;
  animation["samplers"] = json::array({{{"input", input}, {"output", output}, {"interpolation", interpolation}}});
  animation["channels"] = json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}});
  file.root["animations"].push_back(animation);
}

TEST(GltfMeshes, AnimateMorphTargets) {
  GltfFile file = morph_file();
  animate(file, "weights", "LINEAR", file.accessor<float>({0, 2}, "SCALAR"),
          file.accessor<float>({0, 0, 1, 1}, "SCALAR"));
  expect_point(file.parse({.camera = {}, .variant = {}, .animation = {}, .time = 0.5}).mesh().positions[0],
               {0.5, 0, 0.25});
}

Vec3d origin_at(GltfFile& file, const std::string& animation, double time) {
  ReadOptions options;
  options.animation = animation;
  options.time = time;
  return file.parse(options).shapes()[0].world_from_object.start.point({});
}

TEST(GltfMeshes, InterpolateKeyframesInEveryWay) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const int times = file.accessor<float>({1, 3}, "SCALAR");
  const int values = file.accessor<float>({0, 0, 0, 4, 0, 0}, "VEC3");
  // In-tangent, value, out-tangent of each key.
  const int spline = file.accessor<float>({0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3");
  animate(file, "translation", "LINEAR", times, values);
  animate(file, "translation", "STEP", times, values);
  animate(file, "translation", "CUBICSPLINE", times, spline);
  expect_point(file.parse().shapes()[0].world_from_object.start.point({}), {0, 0, 0});
  expect_point(origin_at(file, "LINEAR", 1.5), {1, 0, 0});
  expect_point(origin_at(file, "LINEAR", -1), {0, 0, 0});
  expect_point(origin_at(file, "LINEAR", 99), {4, 0, 0});
  expect_point(origin_at(file, "STEP", 2.9), {0, 0, 0});
  expect_point(origin_at(file, "STEP", 3), {4, 0, 0});
  // Hermite interpolation at one half: half of 4, and span * (1/8 of the out-tangent).
  expect_point(origin_at(file, "CUBICSPLINE", 2), {2.25, 0, 0});
  expect_point(origin_at(file, "2", 1), {0, 0, 0});
  EXPECT_THROW(origin_at(file, "none of them", 1), InputError);
}

TEST(GltfMeshes, TurnAlongTheShorterArc) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const float half = std::numbers::sqrt2_v<float> / 2;
  animate(file, "rotation", "LINEAR", file.accessor<float>({0, 1}, "SCALAR"),
          file.accessor<float>({0, 0, 0, 1, 0, 0, -half, -half}, "VEC4"));
  ReadOptions options;
  options.time = 0.5;
  const Vec3d x = file.parse(options).shapes()[0].world_from_object.start.direction({1, 0, 0});
  expect_point(x, {std::cos(std::numbers::pi / 4), std::sin(std::numbers::pi / 4), 0});
}

TEST(GltfMeshes, BlendSkins) {
  GltfFile file;
  json primitive = file.triangle();
  primitive["attributes"]["JOINTS_0"] = file.accessor<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  primitive["attributes"]["WEIGHTS_0"] = file.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
  // The bind pose has joint 1 at (0, 0, -1).
  const int inverse_bind = file.accessor<float>(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}, "MAT4");
  file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse_bind}}};
  // The node's own transform does not matter.
  file.add_node({{"mesh", file.add_mesh(primitive)}, {"skin", 0}, {"translation", {100, 0, 0}}});
  file.add_node({{"translation", {0, 0, 0}}});
  file.add_node({{"translation", {0, 0, 3}}});
  const Mesh mesh = file.parse().mesh();
  expect_point(mesh.positions[0], {0, 0, 0});
  expect_point(mesh.positions[1], {1, 0, 4});
  expect_point(mesh.positions[2], {0, 1, 2});
  file.root["skins"][0]["joints"] = {1};
  EXPECT_NE(file.error().find("joint 1 is out of range"), std::string::npos);
}

}  // namespace

}  // namespace alhazen::impl::test
