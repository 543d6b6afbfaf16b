// Materials, textures, lights, cameras and variants of glTF files, and what is refused.

#include <numbers>

#include "unit/io/gltf_support.h"

namespace alhazen::impl::test {

namespace {

Vec3d constant(const ParsedGltf& parsed, uint32_t texture) {
  EXPECT_LT(texture, parsed.scene.textures.size());
  EXPECT_EQ(parsed.texture(texture).kind, TextureKind::constant);
  return parsed.texture(texture).value;
}

TEST(GltfMaterials, ReadTheMetallicRoughnessModel) {
  GltfFile file;
  const int texture = file.add_texture();
  json material{{"doubleSided", true}, {"name", "painted"}};
  material["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 1, 1}},
                                      {"baseColorTexture", {{"index", texture}}},
                                      {"metallicFactor", 0.75},
                                      {"roughnessFactor", 0.5},
                                      {"metallicRoughnessTexture", {{"index", texture}, {"texCoord", 1}}}};
  file.add_triangle_of(material);
  const ParsedGltf parsed = file.parse();
  const Material& m = parsed.material();
  EXPECT_EQ(m.kind, MaterialKind::principled);
  EXPECT_EQ(m.name, "painted");
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(m.alpha, no_index);
  const Texture& base = parsed.texture(m.principled.base_colour);
  ASSERT_EQ(base.kind, TextureKind::scale);
  expect_point(constant(parsed, base.inputs[0]), {0.5, 0.25, 1});
  const Texture& map = parsed.texture(base.inputs[1]);
  ASSERT_EQ(map.kind, TextureKind::image);
  EXPECT_TRUE(parsed.scene.images[map.image].srgb);
  const Texture& metallic = parsed.texture(m.principled.metallic);
  expect_point(constant(parsed, metallic.inputs[0]), {0.75, 0.75, 0.75});
  const Texture& channel = parsed.texture(metallic.inputs[1]);
  EXPECT_EQ(channel.kind, TextureKind::channel);
  EXPECT_EQ(channel.channel, 2);
  EXPECT_EQ(parsed.texture(channel.inputs[0]).uv_set, 1);
  EXPECT_FALSE(parsed.scene.images[parsed.texture(channel.inputs[0]).image].srgb);
  EXPECT_EQ(parsed.texture(parsed.texture(m.principled.roughness).inputs[1]).channel, 1);
}

TEST(GltfMaterials, DefaultToWhiteRoughMetal) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const ParsedGltf parsed = file.parse();
  const Principled& p = parsed.material().principled;
  EXPECT_EQ(p.base_colour, no_index);
  EXPECT_EQ(p.roughness, no_index);
  expect_point(constant(parsed, p.metallic), {1, 1, 1});
  EXPECT_FALSE(parsed.material().double_sided);
}

TEST(GltfMaterials, ReadAlphaModes) {
  for (const std::string mode : {"OPAQUE", "MASK", "BLEND"}) {
    GltfFile file;
    const int texture = file.add_texture(true);
    json material{{"alphaMode", mode}, {"alphaCutoff", 0.25}};
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0.5}},
                                        {"baseColorTexture", {{"index", texture}}}};
    file.add_triangle_of(material);
    const ParsedGltf parsed = file.parse();
    uint32_t alpha = parsed.material().alpha;
    if (mode == "OPAQUE") {
      EXPECT_EQ(alpha, no_index);
      continue;
    }
    if (mode == "MASK") {
      EXPECT_EQ(parsed.texture(alpha).kind, TextureKind::threshold);
      EXPECT_EQ(parsed.texture(alpha).value.x, 0.25);
      alpha = parsed.texture(alpha).inputs[0];
    }
    ASSERT_EQ(parsed.texture(alpha).kind, TextureKind::scale);
    expect_point(constant(parsed, parsed.texture(alpha).inputs[0]), {0.5, 0.5, 0.5});
    const ImageTexels& image = parsed.scene.images[parsed.texture(parsed.texture(alpha).inputs[1]).image];
    EXPECT_FALSE(image.srgb);
    EXPECT_EQ(image.bytes.front(), 255);
    EXPECT_EQ(image.bytes.back(), 0);
  }
}

TEST(GltfMaterials, ReadEmissionAndUnlit) {
  GltfFile file;
  const int texture = file.add_texture();
  json material{{"emissiveFactor", {1, 0.5, 0}}, {"emissiveTexture", {{"index", texture}}}};
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
  file.add_triangle_of(material);
  json unlit{{"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 1}}}}};
  unlit["extensions"]["KHR_materials_unlit"] = json::object();
  file.add_triangle_of(unlit);
  const ParsedGltf parsed = file.parse();
  const Emission& emission = parsed.shapes()[0].emission.value();
  expect_point(emission.radiance, {4, 2, 0});
  EXPECT_FALSE(emission.two_sided);
  EXPECT_TRUE(parsed.scene.images[parsed.texture(emission.texture).image].srgb);
  const Emission& flat = parsed.shapes()[1].emission.value();
  EXPECT_TRUE(flat.two_sided);
  expect_point(constant(parsed, flat.texture), {0.25, 0.5, 1});
  expect_point(constant(parsed, parsed.material(1).reflectance), {0, 0, 0});
}

TEST(GltfMaterials, ReadTheExtensionsOfMaterials) {
  GltfFile file;
  const int texture = file.add_texture(true);
  const json use{{"index", texture}};
  json material{{"normalTexture", {{"index", texture}, {"scale", 0.5}}}};
  material["extensions"] = {
      {"KHR_materials_transmission", {{"transmissionFactor", 0.5}, {"transmissionTexture", use}}},
      {"KHR_materials_volume",
       {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 0.25, 1}}}},
      {"KHR_materials_ior", {{"ior", 1.25}}},
      {"KHR_materials_clearcoat",
       {{"clearcoatFactor", 0.5},
        {"clearcoatRoughnessFactor", 0.25},
        {"clearcoatRoughnessTexture", use},
        {"clearcoatNormalTexture", use}}},
      {"KHR_materials_sheen",
       {{"sheenColorFactor", {0.5, 0, 1}}, {"sheenRoughnessFactor", 0.5}, {"sheenRoughnessTexture", use}}},
      {"KHR_materials_specular",
       {{"specularFactor", 0.5}, {"specularTexture", use}, {"specularColorFactor", {2, 1, 0.5}}}},
      {"KHR_materials_iridescence",
       {{"iridescenceFactor", 0.5},
        {"iridescenceIor", 1.5},
        {"iridescenceThicknessMinimum", 200},
        {"iridescenceThicknessMaximum", 300},
        {"iridescenceThicknessTexture", use}}},
      {"KHR_materials_anisotropy",
       {{"anisotropyStrength", 0.5}, {"anisotropyRotation", std::numbers::pi / 2}, {"anisotropyTexture", use}}},
      {"KHR_materials_dispersion", {{"dispersion", 0.25}}}};
  file.add_triangle_of(material);
  const ParsedGltf parsed = file.parse();
  const Material& m = parsed.material();
  const Principled& p = m.principled;
  EXPECT_EQ(m.normal_scale, 0.5);
  EXPECT_EQ(parsed.texture(m.normal_map).kind, TextureKind::image);
  EXPECT_TRUE(m.double_sided);  // a volume is also hit from inside
  EXPECT_FALSE(p.thin);
  EXPECT_EQ(p.attenuation_distance, 2);
  expect_point(p.attenuation_colour, {0.5, 0.25, 1});
  EXPECT_EQ(p.ior, 1.25);
  EXPECT_EQ(p.dispersion, 0.25);
  EXPECT_EQ(parsed.texture(parsed.texture(p.transmission).inputs[1]).channel, 0);
  expect_point(constant(parsed, p.clearcoat), {0.5, 0.5, 0.5});
  EXPECT_EQ(parsed.texture(parsed.texture(p.clearcoat_roughness).inputs[1]).channel, 1);
  EXPECT_NE(p.clearcoat_normal_map, no_index);
  expect_point(constant(parsed, p.sheen_colour), {0.5, 0, 1});
  // Sheen roughness and specular are stored in alpha.
  for (const uint32_t scalar : {p.sheen_roughness, p.specular}) {
    const ImageTexels& image = parsed.scene.images[parsed.texture(parsed.texture(scalar).inputs[1]).image];
    EXPECT_EQ(image.bytes.back(), 0);
    EXPECT_FALSE(image.srgb);
  }
  expect_point(constant(parsed, p.specular_colour), {2, 1, 0.5});
  EXPECT_EQ(p.iridescence_ior, 1.5);
  const Texture& thickness = parsed.texture(p.iridescence_thickness);
  EXPECT_EQ(thickness.kind, TextureKind::mix);
  expect_point(constant(parsed, thickness.inputs[0]), {200, 200, 200});
  EXPECT_EQ(parsed.texture(thickness.inputs[2]).channel, 1);
  EXPECT_EQ(parsed.texture(parsed.texture(p.anisotropy).inputs[1]).channel, 2);
  EXPECT_EQ(parsed.texture(p.anisotropy_direction).kind, TextureKind::image);
  EXPECT_NEAR(p.anisotropy_rotation, 90, 1e-9);
  EXPECT_TRUE(parsed.diagnostics.warnings().empty());
}

/// The position in the image of a point of glTF's uv, as (u, v) with v down.
Vec2d mapped(const Texture& t, Vec2d uv) {
  const double c = std::cos(t.uv_rotation * std::numbers::pi / 180),
               r = std::sin(t.uv_rotation * std::numbers::pi / 180);
  const double us = t.uv_scale.x * uv.x, vs = t.uv_scale.y * (1 - uv.y);
  return {c * us - r * vs + t.uv_offset.x, 1 - (r * us + c * vs + t.uv_offset.y)};
}

TEST(GltfMaterials, TransformTextureCoordinates) {
  GltfFile file;
  const int texture = file.add_texture();
  json info{{"index", texture}};
  const double angle = 0.3;
  info["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.1, 0.2}}, {"scale", {2, 3}}, {"rotation", angle}, {"texCoord", 1}};
  file.add_triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}});
  const ParsedGltf parsed = file.parse();
  const Texture& node = parsed.texture(parsed.material().principled.base_colour);
  EXPECT_EQ(node.uv_set, 1);
  // Translation * rotation * scale, with the rotation counter-clockwise as seen in the image.
  const double c = std::cos(angle), s = std::sin(angle), u = 0.7, v = 0.4;
  const Vec2d at = mapped(node, {u, v});
  EXPECT_NEAR(at.x, c * 2 * u + s * 3 * v + 0.1, 1e-12);
  EXPECT_NEAR(at.y, -s * 2 * u + c * 3 * v + 0.2, 1e-12);
}

TEST(GltfMaterials, ReadSamplers) {
  GltfFile file;
  const int texture = file.add_texture(false, {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  file.add_triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  const ParsedGltf parsed = file.parse();
  const Texture& node = parsed.texture(parsed.material().principled.base_colour);
  EXPECT_EQ(node.wrap, WrapMode::clamp);
  EXPECT_EQ(node.wrap_t, WrapMode::mirror);
  EXPECT_TRUE(node.nearest);
}

TEST(GltfMaterials, TakeHigherSetsOfTextureCoordinates) {
  GltfFile file;
  const int texture = file.add_texture();
  file.add_triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 2}}}}}});
  const int uvs = file.accessor<float>({0.25f, 0.25f, 0.5f, 0.5f, 0, 0}, "VEC2");
  file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_2"] = uvs;
  const ParsedGltf parsed = file.parse();
  EXPECT_EQ(parsed.texture(parsed.material().principled.base_colour).uv_set, 1);
  EXPECT_EQ(parsed.mesh().second_uvs[0], (Vec2f{0.25f, 0.75f}));
}

TEST(GltfMaterials, ChooseVariants) {
  GltfFile file;
  file.root["materials"] = {{{"name", "plain"}}, {{"name", "red"}}, {{"name", "blue"}}};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Red"}}, {{"name", "Blue"}}};
  json primitive = file.triangle();
  primitive["material"] = 0;
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                   {{"material", 2}, {"variants", {1}}}};
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  ReadOptions options;
  EXPECT_EQ(file.parse(options).material().name, "plain");
  options.variant = "Red";
  EXPECT_EQ(file.parse(options).material().name, "red");
  options.variant = "Blue";
  EXPECT_EQ(file.parse(options).material().name, "blue");
  options.variant = "1";
  EXPECT_EQ(file.parse(options).material().name, "blue");
  options.variant = "Green";
  EXPECT_NE(file.error(options).find("there is no variant 'Green'; it may be one of 0 'Red', 1 'Blue'"),
            std::string::npos);
}

TEST(GltfMaterials, VariantsLeaveWhatTheyDoNotName) {
  GltfFile file;
  file.root["materials"] = {{{"name", "plain"}}, {{"name", "red"}}};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Red"}}, {{"name", "Blue"}}};
  json primitive = file.triangle();
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  ReadOptions options;
  EXPECT_EQ(file.parse(options).material().name, "") << "the default material";
  options.variant = "Blue";
  EXPECT_EQ(file.parse(options).material().name, "") << "no mapping of this variant";
  options.variant = "0";
  EXPECT_EQ(file.parse(options).material().name, "red");
}

TEST(GltfMaterials, PreferTheImageThatCanBeRead) {
  GltfFile file;
  const int texture = file.add_texture();
  file.root["images"].push_back({{"uri", "data:image/webp;base64,UklGRg=="}});
  file.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  file.root["extensionsUsed"] = {"EXT_texture_webp"};
  file.add_triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  EXPECT_EQ(file.parse().scene.images.size(), 1u);
  EXPECT_TRUE(file.parse().diagnostics.warnings().empty());
  // Without the other image this one is read, which is only a header.
  file.root["textures"][0].erase("source");
  EXPECT_NE(file.error().find("WebP"), std::string::npos) << file.error();
  file.root["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}};
  EXPECT_NE(file.error().find("KHR_texture_basisu"), std::string::npos) << file.error();
}

// Lights and cameras ------------------------------------------------------------------------------------------------

TEST(GltfLights, ReadPunctualLights) {
  GltfFile file;
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 10}, {"color", {1, 0.5, 0}}},
      {{"type", "directional"}, {"intensity", 3}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const double half = std::numbers::sqrt2 / 2;
  for (int i = 0; i < 3; ++i) {
    json node{{"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}};
    node["extensions"]["KHR_lights_punctual"]["light"] = i;
    file.add_node(node);
  }
  const ParsedGltf parsed = file.parse();
  // The last is the neutral light, which files without a camera get too.
  ASSERT_EQ(parsed.scene.lights.size(), 4u);
  EXPECT_EQ(parsed.scene.lights[3].kind, LightKind::environment);
  EXPECT_EQ(parsed.scene.lights[0].kind, LightKind::point);
  expect_point(parsed.scene.lights[0].radiance, {10, 5, 0});
  expect_point(parsed.scene.lights[0].position, {1, 2, 3});
  EXPECT_EQ(parsed.scene.lights[1].kind, LightKind::distant);
  // -z, rotated by 90 degrees about y.
  expect_point(parsed.scene.lights[1].direction, {-1, 0, 0});
  EXPECT_NEAR(parsed.scene.lights[2].cone_angle, 0.2 * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(parsed.scene.lights[2].falloff_start, 0.1 * 180 / std::numbers::pi, 1e-9);
}

TEST(GltfLights, LightWhatHasNoLights) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const ParsedGltf parsed = file.parse();
  ASSERT_EQ(parsed.scene.lights.size(), 1u);
  EXPECT_EQ(parsed.scene.lights[0].kind, LightKind::environment);
  EXPECT_EQ(parsed.scene.environments.size(), 1u);
}

TEST(GltfCameras, ReadPerspectiveAndOrthographicOnes) {
  GltfFile file;
  file.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 0.5}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  file.add_node({{"camera", 0}, {"translation", {0, 0, 5}}, {"name", "front"}, {"scale", {3, 3, 3}}});
  file.add_node({{"camera", 1}, {"translation", {0, 7, 0}}, {"name", "flat"}});
  ReadOptions options;
  const ParsedGltf first = file.parse(options);
  const Camera& camera = first.scene.camera;
  const Transform& world = camera.world_from_camera.start;
  expect_point(world.point({}), {0, 0, 5});
  expect_point(world.direction({0, 0, 1}), {0, 0, -1});
  expect_point(world.direction({1, 0, 0}), {1, 0, 0});
  expect_point(world.direction({0, 1, 0}), {0, 1, 0});
  EXPECT_EQ(first.scene.film.width, 640);
  EXPECT_EQ(first.scene.film.height, 1280);
  // Over the width, which is the shorter side.
  EXPECT_NEAR(camera.fov, 2 * std::atan(0.5 * std::tan(0.25)) * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(camera.kind, CameraKind::perspective);
  options.camera = "flat";
  const ParsedGltf second = file.parse(options);
  EXPECT_EQ(second.scene.camera.kind, CameraKind::orthographic);
  expect_point(second.scene.camera.world_from_camera.start.point({0, 0, 0}), {0, 7, 0});
  // A window of [-1, 1] over the height is ymag high.
  expect_point(second.scene.camera.world_from_camera.start.direction({0, 1, 0}), {0, 2, 0});
  EXPECT_EQ(second.scene.film.width, 1280);
  EXPECT_EQ(second.scene.film.height, 640);
  options.camera = "1";
  EXPECT_EQ(file.parse(options).scene.camera.kind, CameraKind::orthographic);
  options.camera = "7";
  EXPECT_NE(file.error(options).find("no camera '7'; it may be one of 0 'front', 1 'flat'"), std::string::npos);
  options.camera = "\x1b[31m\u00e9";
  EXPECT_NE(file.error(options).find("no camera '\\x1b[31m\u00e9'"), std::string::npos) << file.error(options);
}

TEST(GltfCameras, FrameWhatHasNoCamera) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}, {"scale", {100, 100, 100}}, {"translation", {0, 0, -900}}});
  const ParsedGltf parsed = file.parse();
  const Camera& camera = parsed.scene.camera;
  const Transform camera_from_world = camera.world_from_camera.start.inverse();
  const double tangent = std::tan(camera.fov * std::numbers::pi / 360);
  for (const Vec3d corner : {Vec3d{0, 0, -900}, Vec3d{100, 0, -900}, Vec3d{0, 100, -900}}) {
    const Vec3d p = camera_from_world.point(corner);
    EXPECT_GT(p.z, 0);
    EXPECT_LT(std::abs(p.x), tangent * p.z);
    EXPECT_LT(std::abs(p.y), tangent * p.z);
  }
  // x is to the right, so that text can be read.
  EXPECT_GT(camera_from_world.direction({1, 0, 0}).x, 0);
}

/// By the size of the scene in the image, whatever its size in metres.
TEST(GltfCameras, FrameTheSmallestAsTheLargest) {
  const auto height_in_image = [](double scale) {
    GltfFile file;
    file.add_node({{"mesh", file.add_mesh(file.triangle())}, {"scale", {scale, scale, scale}}});
    const Camera camera = file.parse().scene.camera;
    const Transform camera_from_world = camera.world_from_camera.start.inverse();
    const Vec3d foot = camera_from_world.point({0, 0, 0}), head = camera_from_world.point({0, scale, 0});
    return head.y / head.z - foot.y / foot.z;
  };
  const double expected = height_in_image(1);
  EXPECT_GT(expected, 0.1);
  for (const double scale : {1e-6, 1e-9, 1e-10, 1e-12, 1e-15, 1e6, 1e12})
    EXPECT_NEAR(height_in_image(scale), expected, 1e-6) << scale;
}

// Errors ------------------------------------------------------------------------------------------------------------

TEST(GltfErrors, NameUnknownExtensions) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  file.root["extensionsUsed"] = {"EXT_of_nobody"};
  EXPECT_TRUE(file.parse().warned("'EXT_of_nobody' is not supported"));
  file.root["extensionsRequired"] = {"EXT_of_nobody"};
  EXPECT_NE(file.error().find("requires the extension 'EXT_of_nobody'"), std::string::npos);
}

TEST(GltfErrors, TellThePlaceOfBadJson) {
  EXPECT_NE(error_of_gltf("{\n  \"asset\": {\n  \"version\": 2.0.0 }}").find("test.gltf:3:14: "), std::string::npos);
  EXPECT_NE(error_of_gltf("{\"asset\":").find("test.gltf:1:10: "), std::string::npos);
  EXPECT_NE(error_of_gltf("").find("test.gltf:1:1: "), std::string::npos);
  EXPECT_NE(error_of_gltf(std::string(100'000, '[')).find("nested deeper"), std::string::npos);
  EXPECT_NE(error_of_gltf("{\"asset\": {\"version\": \"1.0\"}}").find("convert it"), std::string::npos);
}

TEST(GltfErrors, TellIndicesOutOfRange) {
  GltfFile file;
  json primitive = file.triangle();
  primitive["indices"] = file.accessor<uint8_t>({0, 1, 3}, "SCALAR");
  file.add_node({{"mesh", file.add_mesh(primitive)}});
  EXPECT_NE(file.error().find("vertex index 3 is out of range: the mesh has 3 vertices"), std::string::npos);
  file.root["nodes"][0]["mesh"] = 1;
  EXPECT_NE(file.error().find("\"meshes\" has 1 items"), std::string::npos);
  file.root["nodes"][0]["mesh"] = -1;
  EXPECT_NE(file.error().find("must be a whole number that is not negative"), std::string::npos);
  file.root["nodes"][0]["mesh"] = "one";
  EXPECT_FALSE(file.error().empty());
}

TEST(GltfErrors, RefuseEveryTruncatedBinaryFile) {
  GltfFile file;
  file.add_node({{"mesh", file.add_mesh(file.triangle())}});
  const std::string whole = file.glb();
  for (size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(error_of_gltf(whole.substr(0, size)).empty()) << size;
  EXPECT_EQ(error_of_gltf(whole), "");
}

}  // namespace

}  // namespace alhazen::impl::test
