// Extensions of glTF that affect the whole file: hidden nodes, animated values, WebP, diffuse transmission; and how
// files without cameras or lights are viewed and lit.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {
namespace {

TEST(GltfVisibility, HidesNodesWithWhatIsBelowThem) {
  GltfFile file;
  const int mesh = file.add_mesh(file.triangle());
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  json light{{"translation", {0, 1, 0}}};
  light["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const int child = file.add_node({{"mesh", mesh}}), lamp = file.add_node(light);
  json parent{{"children", {child, lamp}}};
  parent["extensions"]["KHR_node_visibility"]["visible"] = false;
  file.add_node(parent);
  file.add_node({{"mesh", mesh}, {"translation", {5, 0, 0}}});
  file.root["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual"};
  file.root["extensionsRequired"] = {"KHR_node_visibility"};
  const ParsedGltf parsed = file.parse();
  ASSERT_EQ(parsed.shapes().size(), 1u);
  expect_point(parsed.shapes()[0].world_from_object.start.point({0, 0, 0}), {5, 0, 0});
  ASSERT_EQ(parsed.scene.lights.size(), 1u);
  EXPECT_EQ(parsed.scene.lights[0].kind, LightKind::environment);
  EXPECT_TRUE(parsed.diagnostics.warnings().empty());
}

/// A file with one animation, which sets the target of `pointer` to `values` at 0 and 2 seconds.
GltfFile animated(const std::string& pointer, const std::vector<float>& values, const std::string& type) {
  GltfFile file;
  file.add_triangle_of({{"pbrMetallicRoughness", {{"roughnessFactor", 0.25}}}, {"alphaMode", "BLEND"}});
  json channel{{"sampler", 0}};
  channel["target"] = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  json sampler{{"input", file.accessor<float>({0, 2}, "SCALAR")}, {"output", file.accessor<float>(values, type)}};
  file.root["animations"] = {{{"channels", {channel}}, {"samplers", {sampler}}}};
  file.root["extensionsUsed"] = {"KHR_animation_pointer", "KHR_node_visibility"};
  return file;
}

ReadOptions at_time(double time) {
  ReadOptions options;
  options.time = time;
  return options;
}

TEST(GltfPointers, AnimateNumbersAndArrays) {
  GltfFile file = animated("/materials/0/pbrMetallicRoughness/roughnessFactor", {0.5f, 1}, "SCALAR");
  const auto roughness = [](const ParsedGltf& parsed) {
    return parsed.texture(parsed.material().principled.roughness).value.x;
  };
  EXPECT_NEAR(roughness(file.parse()), 0.25, 1e-6);
  EXPECT_NEAR(roughness(file.parse(at_time(1))), 0.75, 1e-6);
  // Members absent in the file are added.
  GltfFile colour = animated("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 0, 0, 1, 0, 0, 1, 1}, "VEC4");
  const ParsedGltf parsed = colour.parse(at_time(0.5));
  expect_point(parsed.texture(parsed.material().principled.base_colour).value, {0.75, 0, 0.25});
  EXPECT_TRUE(parsed.diagnostics.warnings().empty());
}

TEST(GltfPointers, AnimateNodesAndTheirVisibility) {
  EXPECT_EQ(
      animated("/nodes/0/extensions/KHR_node_visibility/visible", {0, 0}, "SCALAR").parse(at_time(1)).shapes().size(),
      0u);
  const ParsedGltf moved = animated("/nodes/0/translation", {0, 0, 0, 4, 0, 0}, "VEC3").parse(at_time(1));
  expect_point(moved.shapes().at(0).world_from_object.start.point({0, 0, 0}), {2, 0, 0});
}

TEST(GltfPointers, ThatLeadNowhereAreAWarning) {
  for (const std::string pointer :
       {"/materials/7/alphaCutoff", "/asset/version/x", "nothing", "", "/animations/0/samplers/0",
        "/materials/0/a/b/c/d/e/f/g/h/i/j/k/l/m/n/o/p/q/r/s/t"}) {
    const ParsedGltf parsed = animated(pointer, {0, 1}, "SCALAR").parse(at_time(1));
    EXPECT_TRUE(parsed.warned("refers to nothing")) << pointer;
    EXPECT_EQ(parsed.shapes().size(), 1u);
  }
}

TEST(GltfPointers, CannotMakeABadFileOfAGoodOne) {
  EXPECT_NE(animated("/nodes/0/mesh", {5, 5}, "SCALAR").error(at_time(1)), "");
  EXPECT_NE(animated("/meshes/0/primitives/0/attributes", {5, 5}, "SCALAR").error(at_time(1)), "");
}

#ifdef ALHAZEN_WITH_WEBP
TEST(GltfWebp, ReadsColourAndAlpha) {
  GltfFile file;
  const int texture = file.add_texture();
  file.root["images"][0]["uri"] = "data:image/webp;base64,UklGRiAAAABXRUJQVlA4TBMAAAAvAEAAEA8w//M///Mf8JiAiP5HAA==";
  file.root["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"EXT_texture_webp"};
  file.add_triangle_of(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}, {"alphaMode", "BLEND"}});
  const ParsedGltf parsed = file.parse();
  const ImageTexels& colour = parsed.scene.images.at(parsed.texture(parsed.material().principled.base_colour).image);
  EXPECT_TRUE(colour.srgb);
  EXPECT_EQ(colour.bytes, (std::vector<uint8_t>{255, 255, 255, 0, 0, 0}));
  const ImageTexels& alpha = parsed.scene.images.at(parsed.texture(parsed.material().alpha).image);
  EXPECT_FALSE(alpha.srgb);
  EXPECT_EQ(alpha.bytes, (std::vector<uint8_t>{255, 0}));
  EXPECT_EQ(alpha.channels, 1);
}

TEST(GltfWebp, RefusesWhatIsDamaged) {
  GltfFile file;
  const int texture = file.add_texture();
  file.root["images"][0]["uri"] = "data:image/webp;base64,UklGRiAAAABXRUJQVlA4TBMAAAAvAEAAEA8w//M=";
  file.add_triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  EXPECT_NE(file.error().find("not a readable WebP file"), std::string::npos) << file.error();
}
#endif

TEST(GltfMaterials, ReadDiffuseTransmission) {
  GltfFile file;
  json material{{"extensions",
                 {{"KHR_materials_diffuse_transmission",
                   {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {1, 0.5, 0}}}}}}};
  file.add_triangle_of(material);
  file.root["extensionsUsed"] = {"KHR_materials_diffuse_transmission"};
  const ParsedGltf parsed = file.parse();
  const Principled& p = parsed.material().principled;
  EXPECT_EQ(parsed.texture(p.diffuse_transmission).value.x, 0.25);
  expect_point(parsed.texture(p.diffuse_transmission_colour).value, {1, 0.5, 0});
  EXPECT_TRUE(parsed.diagnostics.warnings().empty());
}

// Views and lights ----------------------------------------------------------------------------------------------------

/// A row of triangles, `wide` times as wide as it is high.
ParsedGltf row(double wide, double aspect) {
  GltfFile file;
  const int mesh = file.add_mesh(file.triangle());
  file.add_node({{"mesh", mesh}});
  file.add_node({{"mesh", mesh}, {"translation", {wide - 1, 0, 0}}});
  ReadOptions options;
  options.aspect = aspect;
  return file.parse(options);
}

TEST(GltfCameras, FillImagesOfAnyShape) {
  for (const double aspect : {0.0, 0.5, 1.0, 3.0})
    for (const double wide : {1.0, 4.0}) {
      const ParsedGltf parsed = row(wide, aspect);
      const Transform camera_from_world = parsed.scene.camera.world_from_camera.start.inverse();
      const double shape = aspect == 0 ? 1280.0 / 720 : aspect;
      const double tangent = std::tan(parsed.scene.camera.fov * std::numbers::pi / 360);
      double across = 0, along = 0;
      for (const Vec3d corner : {Vec3d{0, 0, 0}, Vec3d{wide, 0, 0}, Vec3d{0, 1, 0}, Vec3d{wide - 1, 1, 0}}) {
        const Vec3d p = camera_from_world.point(corner);
        ASSERT_GT(p.z, 0);
        across = std::max(across, std::abs(p.x) / (p.z * tangent * std::max(shape, 1.0)));
        along = std::max(along, std::abs(p.y) / (p.z * tangent / std::min(shape, 1.0)));
      }
      EXPECT_LT(std::max(across, along), 1) << aspect << " " << wide;
      EXPECT_GT(std::max(across, along), 0.85) << aspect << " " << wide;
    }
}

/// A camera at the origin, in a box that is closed except for its last `open` triangles.
ParsedGltf room(size_t open) {
  std::vector<float> corners;
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4}) corners.push_back(i & bit ? 1.5f : -1);
  std::vector<uint16_t> indices{0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4,
                                0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 2, 6, 3, 3, 6, 7};
  indices.resize(indices.size() - 3 * open);
  GltfFile file;
  json primitive;
  primitive["attributes"]["POSITION"] = file.accessor<float>(corners, "VEC3");
  primitive["indices"] = file.accessor<uint16_t>(indices, "SCALAR");
  primitive["material"] = 0;
  file.root["materials"] = {
      {{"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 1}}}}}};
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  file.add_node({{"camera", 0}});
  return file.parse();
}

TEST(GltfLights, ClosedRoomsEmitTheirOwnColour) {
  const ParsedGltf closed = room(0);
  ASSERT_TRUE(closed.shapes().at(0).emission);
  expect_point(closed.texture(closed.shapes()[0].emission->texture).value, {1, 0.5, 0.25});
  EXPECT_TRUE(closed.scene.lights.empty());
  EXPECT_TRUE(closed.warned("nothing emits light within the walls"));
  const ParsedGltf open = room(2);
  EXPECT_FALSE(open.shapes().at(0).emission);
  EXPECT_EQ(open.scene.lights.size(), 1u);
  EXPECT_TRUE(open.diagnostics.warnings().empty());
}

}  // namespace
}  // namespace alhazen::impl::test
