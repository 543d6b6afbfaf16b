// Textures of pbrt scenes.

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "compile/materials.h"
#include "core/textures/texture.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

const Texture& named(const Parsed& p, const std::string& name) {
  for (const Texture& texture : p.scene.textures)
    if (texture.name == name) return texture;
  throw std::runtime_error("no texture " + name);
}

TEST(PbrtTextures, Constant) {
  const Parsed p = parse_world(
      "Texture \"a\" \"float\" \"constant\" \"float value\" 0.3\n"
      "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ 1 2 3 ]\n"
      "Material \"diffuse\" \"texture reflectance\" \"a\" Shape \"sphere\"");
  expect_near(p.scene.textures[0].value, {0.3, 0.3, 0.3});
  expect_near(constant_of(p, material_of(p, shapes(p)[0]).reflectance), {1, 2, 3});
}

TEST(PbrtTextures, ConstantsAreShared) {
  const Parsed p = parse_world(
      "Material \"diffuse\" \"rgb reflectance\" [ .2 .2 .2 ] Shape \"sphere\" "
      "Material \"diffuse\" \"rgb reflectance\" [ .2 .2 .2 ] Shape \"sphere\"");
  EXPECT_EQ(p.scene.textures.size(), 1u);
}

TEST(PbrtTextures, ScaleAndMix) {
  const Parsed p = parse_world(
      "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ 1 2 3 ]\nTexture \"f\" \"float\" \"fbm\"\n"
      "Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5\n"
      "Texture \"m\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0 0 1 ] \"texture tex2\" \"a\" \"texture amount\" \"f\"\n"
      "Texture \"d\" \"float\" \"mix\"");
  const Texture& scale = named(p, "s");
  EXPECT_EQ(scale.kind, TextureKind::scale);
  expect_near(constant_of(p, scale.inputs[0]), {1, 2, 3});
  expect_near(constant_of(p, scale.inputs[1]), {0.5, 0.5, 0.5});
  const Texture& mix = named(p, "m");
  EXPECT_EQ(mix.kind, TextureKind::mix);
  expect_near(constant_of(p, mix.inputs[0]), {0, 0, 1});
  expect_near(constant_of(p, mix.inputs[1]), {1, 2, 3});
  EXPECT_EQ(p.scene.textures[mix.inputs[2]].kind, TextureKind::fbm);
  expect_near(constant_of(p, named(p, "d").inputs[0]), {0, 0, 0});
  expect_near(constant_of(p, named(p, "d").inputs[1]), {1, 1, 1});
  expect_near(constant_of(p, named(p, "d").inputs[2]), {0.5, 0.5, 0.5});
}

TEST(PbrtTextures, Checkerboard) {
  const Parsed p = parse_world(
      "Translate 1 2 3\nTexture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 0 0 ] \"float uscale\" 20 "
      "\"float vscale\" 10 \"float udelta\" 0.25 \"float vdelta\" 0.5\n"
      "Texture \"d\" \"float\" \"checkerboard\" \"integer dimension\" 3");
  const Texture& flat = named(p, "c");
  EXPECT_EQ(flat.kind, TextureKind::checkerboard);
  EXPECT_FALSE(flat.solid_checks);
  EXPECT_EQ(flat.uv_scale, (Vec2d{20, 10}));
  EXPECT_EQ(flat.uv_offset, (Vec2d{0.25, 0.5}));
  expect_near(constant_of(p, flat.inputs[0]), {1, 0, 0});
  expect_near(constant_of(p, flat.inputs[1]), {0, 0, 0});
  EXPECT_TRUE(named(p, "d").solid_checks);
  expect_near(named(p, "d").texture_from_world.point({1, 2, 3}), {0, 0, 0});
}

TEST(PbrtTextures, Noise) {
  const Parsed p = parse_world(
      "Scale 2 2 2\nTexture \"f\" \"float\" \"fbm\" \"integer octaves\" 4 \"float roughness\" .25\n"
      "Texture \"w\" \"float\" \"wrinkled\"\nTexture \"m\" \"spectrum\" \"marble\" \"float scale\" 3 \"float "
      "variation\" .1");
  EXPECT_EQ(named(p, "f").octaves, 4);
  EXPECT_EQ(named(p, "f").roughness, 0.25);
  expect_near(named(p, "f").texture_from_world.point({2, 4, 6}), {1, 2, 3});
  EXPECT_EQ(named(p, "w").kind, TextureKind::wrinkled);
  EXPECT_EQ(named(p, "w").octaves, 8);
  EXPECT_EQ(named(p, "m").kind, TextureKind::marble);
  EXPECT_EQ(named(p, "m").noise_scale, 3);
  EXPECT_EQ(named(p, "m").variation, 0.1);
}

TEST(PbrtTextures, RarerKinds) {
  const Parsed p = parse_world(
      "Texture \"d\" \"spectrum\" \"dots\" \"rgb inside\" [ 1 0 0 ] \"float uscale\" 5\n"
      "Texture \"w\" \"float\" \"windy\"\n"
      "Rotate 90 0 0 1 Texture \"x\" \"float\" \"directionmix\" \"vector3 dir\" [ 2 0 0 ]");
  EXPECT_EQ(named(p, "d").kind, TextureKind::dots);
  EXPECT_EQ(named(p, "d").uv_scale.x, 5);
  expect_near(constant_of(p, named(p, "d").inputs[0]), {1, 0, 0});
  EXPECT_EQ(named(p, "w").kind, TextureKind::windy);
  EXPECT_EQ(named(p, "x").kind, TextureKind::direction_mix);
  expect_near(named(p, "x").direction, {0, 1, 0});
  for (const char* kind : {"dots", "windy", "directionmix"}) EXPECT_FALSE(p.warned(kind)) << kind;
  EXPECT_NE(error_of("WorldBegin Texture \"p\" \"spectrum\" \"ptex\" \"string filename\" \"x\"").find("ptex"),
            std::string::npos);
}

TEST(PbrtTextures, CellularNoise) {
  const Parsed p = parse_world(
      "Translate 1 2 3\nTexture \"d\" \"float\" \"cellular\"\n"
      "Texture \"c\" \"spectrum\" \"cellular\" \"string value\" \"cell\" \"float jitter\" 0.5");
  EXPECT_EQ(named(p, "d").kind, TextureKind::cellular);
  EXPECT_EQ(named(p, "d").value, (Vec3d{1, 0, 0}));
  EXPECT_EQ(named(p, "c").value, (Vec3d{0.5, 1, 0}));
  expect_near(named(p, "c").texture_from_world.point({1, 2, 3}), {0, 0, 0});
  const std::string begin = "WorldBegin Texture \"t\" \"float\" \"cellular\" ";
  EXPECT_NE(error_of(begin + "\"float jitter\" 2").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(error_of(begin + "\"string value\" \"edge\"").find("distance or cell"), std::string::npos);
  EXPECT_NE(error_of(begin + "\"float scale\" 2").find("scale"), std::string::npos);
}

/// (1 - s) (1 - t) v00 + (1 - s) t v01 + s (1 - t) v10 + s t v11.
TEST(PbrtTextures, BilinearInterpolationOfFourValues) {
  Parsed p = parse_world(
      "Texture \"b\" \"float\" \"bilerp\" \"float v00\" 1 \"float v01\" 2 \"float v10\" 4 \"float v11\" 8\n"
      "Material \"diffuse\" Shape \"sphere\"");
  Material material;
  material.reflectance = static_cast<uint32_t>(&named(p, "b") - p.scene.textures.data());
  p.scene.materials.assign(1, material);
  SceneArrays<double> arrays;
  compile_materials(p.scene, arrays);
  CompiledScene<double> flat;
  arrays.move_into(flat);
  const auto at = [&](double u, double v) {
    return evaluate_texture(flat.view, flat.view.materials[0].diffuse.reflectance, TexturePoint<double>{{}, {u, v}}).x;
  };
  EXPECT_NEAR(at(0, 0), 1, 1e-12);
  EXPECT_NEAR(at(0, 1), 2, 1e-12);
  EXPECT_NEAR(at(1, 0), 4, 1e-12);
  EXPECT_NEAR(at(1, 1), 8, 1e-12);
  EXPECT_NEAR(at(0.25, 0.5), 0.375 + 0.75 + 0.5 + 1, 1e-12);
}

TEST(PbrtTextures, Mappings) {
  const Parsed p = parse_world(
      "Translate 1 0 0\nTexture \"c\" \"float\" \"checkerboard\" \"string mapping\" \"planar\" "
      "\"vector3 v1\" [ 0 2 0 ] \"vector3 v2\" [ 0 0 3 ] \"float udelta\" 0.5\n"
      "Texture \"s\" \"float\" \"dots\" \"string mapping\" \"spherical\"\n"
      "Texture \"y\" \"float\" \"checkerboard\" \"string mapping\" \"cylindrical\"");
  EXPECT_EQ(named(p, "c").mapping, TextureMappingKind::planar);
  expect_near(named(p, "c").texture_from_world.point({5, 1, 2}), {2.5, 6, 0});
  EXPECT_EQ(named(p, "s").mapping, TextureMappingKind::spherical);
  expect_near(named(p, "s").texture_from_world.point({1, 0, 0}), {0, 0, 0});
  EXPECT_EQ(named(p, "y").mapping, TextureMappingKind::cylindrical);
  EXPECT_TRUE(p.diagnostics.warnings().size() <= 1) << "only that there is nothing to see";
}

/// An image of 2 x 1 texels in PFM: linear floats, so nothing is lost.
std::string folder_with_image() {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pbrt_pictures";
  std::filesystem::create_directories(folder);
  std::ofstream file(folder / "p.pfm", std::ios::binary);
  file << "PF\n2 1\n-1.0\n";
  const float texels[6] = {0.25f, 0.5f, 0.75f, 1, 1, 1};
  file.write(reinterpret_cast<const char*>(texels), sizeof texels);
  return folder.string();
}

TEST(PbrtTextures, ImagesAreReadOnceForEachUse) {
  const Parsed p = parse_world(
      "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"p.pfm\" \"string wrap\" \"clamp\" "
      "\"float scale\" 2 \"string filter\" \"point\"\n"
      "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"p.pfm\" \"bool invert\" true\n"
      "Texture \"c\" \"float\" \"imagemap\" \"string filename\" \"p.pfm\" \"string filter\" \"trilinear\"",
      folder_with_image());
  ASSERT_EQ(p.scene.images.size(), 2u) << "one in colour and one in grey";
  EXPECT_EQ(named(p, "a").image, named(p, "b").image);
  EXPECT_EQ(named(p, "a").wrap, WrapMode::clamp);
  EXPECT_TRUE(named(p, "a").nearest);
  EXPECT_EQ(named(p, "a").image_scale, 2);
  EXPECT_TRUE(named(p, "b").invert);
  EXPECT_EQ(named(p, "b").wrap, WrapMode::repeat);
  const ImageTexels& grey = p.scene.images[named(p, "c").image];
  EXPECT_EQ(grey.floats, (std::vector<float>{0.5f, 1}));
  EXPECT_EQ(grey.channels, 1);
}

}  // namespace
}  // namespace alhazen::impl::test
