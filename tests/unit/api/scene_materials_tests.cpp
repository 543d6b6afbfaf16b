// Materials and textures made in memory render to the same bits as those of pbrt files that say the same.

#include <functional>

#include "images/image.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

struct MaterialCase {
  const char* name;
  const char* text;  ///< of pbrt
  std::function<MaterialId(Scene&)> make;
};

void PrintTo(const MaterialCase& material, std::ostream* out) { *out << material.name; }

template <class Kind>
std::function<MaterialId(Scene&)> of(Kind kind) {
  return [kind](Scene& scene) { return scene.add(kind); };
}

/// A diffuse material of that texture.
template <class Kind>
std::function<MaterialId(Scene&)> painted(Kind texture) {
  return [texture](Scene& scene) { return scene.add(Diffuse{.reflectance = scene.add(texture)}); };
}

Transform texture_space() {
  return (Transform::translate({0.3, 0.1, 0}) * Transform::scale({0.5, 0.5, 0.5})).inverse();
}

const std::vector<MaterialCase> cases{
    {"diffuse", R"(Material "diffuse" "rgb reflectance" [0.8 0.3 0.1])", of(Diffuse{.reflectance = {0.8, 0.3, 0.1}})},
    {"diffuse_default", R"(Material "diffuse")", of(Diffuse{})},
    {"oren_nayar", R"(Material "diffuse" "float roughness" 0.6)", of(Diffuse{.roughness = 0.6})},
    {"conductor_copper", R"(Material "conductor" "float roughness" 0.1)", of(Conductor{.roughness = 0.1})},
    {"conductor_gold",
     R"(Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float uroughness" 0.1
        "float vroughness" 0.3 "bool remaproughness" false)",
     [](Scene& scene) {
       Roughness roughness(0.1, 0.3);
       roughness.remap = false;
       return scene.add(Conductor::of(Metal::gold, roughness));
     }},
    {"conductor_reflectance", R"(Material "conductor" "rgb reflectance" [0.9 0.8 0.6])",
     of(Conductor{.reflectance = ColourInput(0.9, 0.8, 0.6)})},
    {"conductor_rgb", R"(Material "conductor" "rgb eta" [0.2 0.4 1.1] "rgb k" [4 2 3] "float uroughness" 0.2)",
     of(Conductor{.eta = ColourInput(0.2, 0.4, 1.1), .k = ColourInput(4, 2, 3), .roughness = {0.2, 0.0}})},
    {"dielectric", R"(Material "dielectric" "float eta" 1.4)", of(Dielectric{.ior = 1.4})},
    {"dielectric_rough", R"(Material "dielectric" "float roughness" 0.2)", of(Dielectric{.roughness = 0.2})},
    {"thin_dielectric", R"(Material "thindielectric" "float eta" 1.3)", of(ThinDielectric{.ior = 1.3})},
    {"coated_diffuse", R"(Material "coateddiffuse" "rgb reflectance" [0.1 0.3 0.7] "float roughness" 0.1)",
     of(CoatedDiffuse{.reflectance = {0.1, 0.3, 0.7}, .roughness = 0.1})},
    {"coated_diffuse_thick", R"(Material "coateddiffuse" "float thickness" 0.4 "float eta" 1.3)",
     of(CoatedDiffuse{.ior = 1.3, .thickness = 0.4})},
    {"coated_conductor",
     R"(Material "coatedconductor" "rgb reflectance" [0.9 0.7 0.5] "float conductor.roughness" 0.3
        "float interface.roughness" 0.1 "float interface.eta" 1.7)",
     of(CoatedConductor{
         .reflectance = ColourInput(0.9, 0.7, 0.5), .roughness = 0.3, .coat_ior = 1.7, .coat_roughness = 0.1})},
    {"diffuse_transmission",
     R"(Material "diffusetransmission" "rgb reflectance" [0.2 0.4 0.1] "rgb transmittance" [0.1 0.5 0.3])",
     of(DiffuseTransmission{.reflectance = {0.2, 0.4, 0.1}, .transmittance = {0.1, 0.5, 0.3}})},
    {"mix",
     R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [0.9 0.1 0.1]
        MakeNamedMaterial "b" "string type" "conductor" "rgb reflectance" [0.5 0.6 0.7]
        Material "mix" "string materials" ["a" "b"] "float amount" 0.3)",
     [](Scene& scene) {
       const MaterialId a = scene.add(Diffuse{.reflectance = {0.9, 0.1, 0.1}});
       const MaterialId b = scene.add(Conductor{.reflectance = ColourInput(0.5, 0.6, 0.7)});
       return scene.add(Mix{.materials = {a, b}, .amount = 0.3});
     }},
    {"displacement",
     R"(Texture "bumps" "float" "fbm" "integer octaves" 3
        Material "diffuse" "texture displacement" "bumps")",
     [](Scene& scene) {
       Material material = Diffuse{};
       material.displacement = scene.add(FbmTexture{.octaves = 3});
       return scene.add(material);
     }},
    {"checkerboard",
     R"(Texture "t" "spectrum" "checkerboard" "rgb tex1" [0.9 0.2 0.2] "rgb tex2" [0.1 0.2 0.3]
          "float uscale" 4 "float vscale" 3 "float udelta" 0.2
        Material "diffuse" "texture reflectance" "t")",
     painted(CheckerboardTexture{
         .even = {0.9, 0.2, 0.2}, .odd = {0.1, 0.2, 0.3}, .mapping = {.scale = {4, 3}, .offset = {0.2, 0}}})},
    {"checkerboard_solid",
     R"(Texture "t" "spectrum" "checkerboard" "integer dimension" 3
        Material "diffuse" "texture reflectance" "t")",
     painted(CheckerboardTexture{.solid = true})},
    {"checkerboard_spherical",
     R"(AttributeBegin Translate 0.3 0.1 0 Scale 0.5 0.5 0.5
        Texture "t" "spectrum" "checkerboard" "string mapping" "spherical" AttributeEnd
        Material "diffuse" "texture reflectance" "t")",
     painted(CheckerboardTexture{.mapping = {.kind = MappingKind::spherical, .texture_from_world = texture_space()}})},
    {"checkerboard_planar",
     R"(Texture "t" "spectrum" "checkerboard" "string mapping" "planar" "vector3 v1" [2 0 1] "vector3 v2" [0 3 0]
          "float udelta" 0.25 "float vdelta" 0.5
        Material "diffuse" "texture reflectance" "t")",
     painted(CheckerboardTexture{
         .mapping = {.kind = MappingKind::planar, .offset = {0.25, 0.5}, .s_axis = {2, 0, 1}, .t_axis = {0, 3, 0}}})},
    {"fbm",
     R"(Texture "t" "spectrum" "fbm" "integer octaves" 4 "float roughness" 0.7
        Material "diffuse" "texture reflectance" "t")",
     painted(FbmTexture{.octaves = 4, .roughness = 0.7})},
    {"wrinkled", R"(Texture "t" "spectrum" "wrinkled" Material "diffuse" "texture reflectance" "t")",
     painted(WrinkledTexture{})},
    {"marble",
     R"(AttributeBegin Translate 0.3 0.1 0 Scale 0.5 0.5 0.5
        Texture "t" "spectrum" "marble" "float scale" 3 "float variation" 0.4 AttributeEnd
        Material "diffuse" "texture reflectance" "t")",
     painted(MarbleTexture{.scale = 3, .variation = 0.4, .texture_from_world = texture_space()})},
    {"windy", R"(Texture "t" "spectrum" "windy" Material "diffuse" "texture reflectance" "t")",
     painted(WindyTexture{})},
    {"cellular",
     R"(Texture "t" "spectrum" "cellular" "float jitter" 0.8 "string value" "cell"
        Material "diffuse" "texture reflectance" "t")",
     painted(CellularTexture{.jitter = 0.8, .per_cell = true})},
    {"dots",
     R"(Texture "t" "spectrum" "dots" "rgb inside" [0.8 0.8 0] "rgb outside" [0 0.2 0.4] "float uscale" 6 "float vscale" 6
        Material "diffuse" "texture reflectance" "t")",
     painted(DotsTexture{.inside = {0.8, 0.8, 0}, .outside = {0, 0.2, 0.4}, .mapping = {.scale = {6, 6}}})},
    {"scale_and_mix",
     R"(Texture "a" "spectrum" "checkerboard" Texture "n" "float" "fbm"
        Texture "s" "spectrum" "scale" "texture tex" "a" "float scale" 0.7
        Texture "t" "spectrum" "mix" "texture tex1" "s" "rgb tex2" [0.2 0.9 0.2] "texture amount" "n"
        Material "diffuse" "texture reflectance" "t")",
     [](Scene& scene) {
       const TextureId checks = scene.add(CheckerboardTexture{});
       const TextureId noise = scene.add(FbmTexture{});
       const TextureId scaled = scene.add(ScaleTexture{.value = checks, .factor = 0.7});
       const TextureId mixed = scene.add(MixTexture{.at_0 = scaled, .at_1 = {0.2, 0.9, 0.2}, .amount = noise});
       return scene.add(Diffuse{.reflectance = mixed});
     }},
    {"coordinates_by_channel",
     R"(Texture "t" "spectrum" "bilerp" "rgb v00" [0 0 0.2] "rgb v01" [1 0 0] "rgb v10" [0 1 0] "rgb v11" [0.5 0.5 1]
        Material "diffuse" "texture reflectance" "t")",
     [](Scene& scene) {
       const TextureId st = scene.add(CoordinatesTexture{});
       const TextureId s = scene.add(ChannelTexture{.input = st, .channel = 0});
       const TextureId t = scene.add(ChannelTexture{.input = st, .channel = 1});
       const TextureId low = scene.add(MixTexture{.at_0 = {0, 0, 0.2}, .at_1 = {0, 1, 0}, .amount = s});
       const TextureId high = scene.add(MixTexture{.at_0 = {1, 0, 0}, .at_1 = {0.5, 0.5, 1}, .amount = s});
       return scene.add(Diffuse{.reflectance = scene.add(MixTexture{.at_0 = low, .at_1 = high, .amount = t})});
     }},
    {"direction_mix",
     R"(Texture "t" "spectrum" "directionmix" "rgb tex1" [0.9 0.1 0.1] "rgb tex2" [0.1 0.1 0.9] "vector3 dir" [1 2 0]
        Material "diffuse" "texture reflectance" "t")",
     painted(DirectionMixTexture{.along = {0.9, 0.1, 0.1}, .perpendicular = {0.1, 0.1, 0.9}, .direction = {1, 2, 0}})},
    {"constant", R"(Texture "t" "spectrum" "constant" "rgb value" [0.1 0.6 0.4]
        Material "diffuse" "texture reflectance" "t")",
     painted(ConstantTexture{.value = {0.1, 0.6, 0.4}})}};

class SceneMaterials : public SceneTest, public ::testing::WithParamInterface<MaterialCase> {};

TEST_P(SceneMaterials, HaveTheBitsOfAFile) {
  const std::string text = std::string(pbrt_view) + "WorldBegin\n" + pbrt_lights + GetParam().text + "\n" + pbrt_floor +
                           "Shape \"sphere\"\n";
  Scene scene;
  scene.set_camera(view_of_pbrt());
  add_lights(scene);
  const MaterialId material = GetParam().make(scene);
  add_floor(scene, material);
  scene.add(Shape{Sphere{}, material});
  const Planes expected = rendered_text(text);
  EXPECT_EQ(rendered(scene), expected);

  // What is read back and set again, also as a new material, is the same.
  Scene again = scene;
  for (const TextureId texture : again.textures()) again.set(texture, again.texture(texture));
  for (const MaterialId each : again.materials()) again.set(each, again.material(each));
  EXPECT_EQ(rendered(again), expected);
  Scene anew = scene;
  const MaterialId copy = anew.add(anew.material(material));
  for (const ShapeId shape : anew.shapes()) anew.set_material(shape, copy);
  EXPECT_EQ(rendered(anew), expected);

  // The same from the file.
  Scene read = Scene::load(folder_.file("scene.pbrt"));
  EXPECT_EQ(rendered(read), expected);
  for (const TextureId texture : read.textures()) read.set(texture, read.texture(texture));
  for (const MaterialId each : read.materials()) read.set(each, read.material(each));
  EXPECT_EQ(rendered(read), expected);
  for (const ShapeId shape : read.shapes()) {
    const MaterialId fresh = read.add(read.material(read.shape(shape).material));
    read.set_material(shape, fresh);
  }
  EXPECT_EQ(rendered(read), expected);
}

INSTANTIATE_TEST_SUITE_P(All, SceneMaterials, ::testing::ValuesIn(cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

using SceneTextures = SceneTest;

TEST_F(SceneTextures, ImagesOfFloatsHaveTheBitsOfAFile) {
  impl::Image image;
  image.width = 3, image.height = 2;
  image.channels = {"R", "G", "B"};
  image.planes = {
      {0.1f, 0.9f, 0.3f, 0.5f, 0.2f, 0.8f}, {0.7f, 0, 1, 0.25f, 0.5f, 0.1f}, {0, 0.4f, 0.6f, 1, 0.9f, 0.3f}};
  impl::write_pfm(folder_.file("image.pfm"), impl::source_of(image), {});
  std::vector<float> interleaved;
  for (size_t i = 0; i < 6; ++i)
    for (size_t c = 0; c < 3; ++c) interleaved.push_back(image.planes[c][i]);
  const std::string text = std::string(pbrt_view) + "WorldBegin\n" + pbrt_lights +
                           R"(Texture "t" "spectrum" "imagemap" "string filename" "image.pfm" "string wrap" "clamp"
                                "float scale" 0.8 "bool invert" true "float uscale" 0.7
                              Material "diffuse" "texture reflectance" "t")" +
                           "\n" + pbrt_floor;
  Scene scene;
  scene.set_camera(view_of_pbrt());
  add_lights(scene);
  const auto image_of = [&] {
    return scene.add(Pixels{.width = 3, .height = 2, .channels = 3, .floats = interleaved});
  };
  const ImageId pixels = image_of();
  std::fill(interleaved.begin(), interleaved.end(), 0.0f);  // they were copied
  const auto paint = [&](ImageId id) {
    return scene.add(Diffuse{
        .reflectance = scene.add(ImageTexture{
            .image = id, .mapping = {.scale = {0.7, 1}}, .wrap = WrapMode::clamp, .scale = 0.8, .invert = true})});
  };
  add_floor(scene, paint(pixels));
  const Planes expected = rendered_text(text);
  EXPECT_EQ(rendered(scene), expected);
  // From the file, and by a copy of what the scene holds.
  const ImageId loaded = scene.load_image(folder_.file("image.pfm"));
  scene.set_material(scene.shapes()[0], paint(loaded));
  EXPECT_EQ(rendered(scene), expected);
  scene.set_image(loaded, Pixels{.width = 1, .height = 1, .channels = 1, .floats = std::vector<float>{0.5f}});
  EXPECT_NE(rendered(scene), expected);
  scene.set_image(loaded, scene.image(pixels));
  EXPECT_EQ(rendered(scene), expected);
}

TEST_F(SceneTextures, ImagesOfBytesHaveTheBitsOfAFile) {
  impl::Image image;
  image.width = 2, image.height = 2;
  image.channels = {"R", "G", "B"};
  image.planes = {{0.1f, 0.9f, 0.3f, 0.5f}, {0.7f, 0, 1, 0.25f}, {0, 0.4f, 0.6f, 1}};
  impl::write_png(folder_.file("image.png"), impl::source_of(image), {});
  for (const bool is_linear : {false, true}) {
    const std::string text = std::string(pbrt_view) + "WorldBegin\n" + pbrt_lights +
                             R"(Texture "t" "spectrum" "imagemap" "string filename" "image.png" "string encoding" )" +
                             (is_linear ? "\"linear\"" : "\"sRGB\"") +
                             "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + pbrt_floor;
    Scene source;
    const ImageId loaded = source.load_image(folder_.file("image.png"));
    const std::vector<uint8_t> bytes(source.image(loaded).bytes.begin(), source.image(loaded).bytes.end());
    ASSERT_EQ(bytes.size(), 12u);
    std::vector<uint8_t> with_alpha;
    for (size_t i = 0; i < 12; ++i) {
      with_alpha.push_back(bytes[i]);
      if (i % 3 == 2) with_alpha.push_back(static_cast<uint8_t>(20 * i));
    }
    const Planes expected = rendered_text(text);
    for (const int channels : {3, 4}) {
      Scene scene;
      scene.set_camera(view_of_pbrt());
      add_lights(scene);
      const ImageId id = scene.add(Pixels{.width = 2,
                                          .height = 2,
                                          .channels = channels,
                                          .bytes = channels == 3 ? bytes : with_alpha,
                                          .encoding = is_linear ? Encoding::linear : Encoding::srgb});
      add_floor(scene, scene.add(Diffuse{.reflectance = scene.add(ImageTexture{.image = id})}));
      EXPECT_EQ(rendered(scene), expected) << channels << ' ' << is_linear;
      if (channels == 3) continue;
      const ImageId alpha =
          scene.add(Pixels{.width = 2, .height = 2, .channels = 4, .bytes = with_alpha, .takes_alpha = true});
      EXPECT_EQ(scene.image(alpha).channels, 1);
      EXPECT_EQ(std::vector<uint8_t>(scene.image(alpha).bytes.begin(), scene.image(alpha).bytes.end()),
                (std::vector<uint8_t>{40, 100, 160, 220}));
      EXPECT_EQ(scene.image(alpha).encoding, Encoding::linear);
    }
  }
}

TEST_F(SceneTextures, ThresholdsAndVertexColours) {
  const auto with = [](const ColourInput& reflectance_input, bool by_threshold) {
    Scene scene;
    scene.set_camera(view_of_pbrt());
    add_lights(scene);
    const MeshId mesh = add_floor(scene);
    std::vector<float> colours;
    for (int i = 0; i < 4; ++i) colours.insert(colours.end(), {0.2f, 0.4f, 0.6f, 0.5f});
    scene.set_mesh(
        mesh,
        MeshArrays{.positions = std::span<const float>(floor_positions), .indices = floor_indices, .colours = colours});
    ColourInput reflectance = reflectance_input;
    if (by_threshold) reflectance = scene.add(ThresholdTexture{.input = reflectance_input, .edge = {0.3, 0.4, 0.7}});
    scene.set_material(scene.shapes()[0], scene.add(Diffuse{.reflectance = reflectance}));
    return rendered(scene);
  };
  Scene scene;
  scene.set_camera(view_of_pbrt());
  add_lights(scene);
  const MeshId mesh = add_floor(scene);
  const std::vector<float> colours{0.2f, 0.4f, 0.6f, 0.2f, 0.4f, 0.6f, 0.2f, 0.4f, 0.6f, 0.2f, 0.4f, 0.6f};
  scene.set_mesh(
      mesh,
      MeshArrays{.positions = std::span<const float>(floor_positions), .indices = floor_indices, .colours = colours});
  scene.set_material(scene.shapes()[0], scene.add(Diffuse{.reflectance = scene.add(VertexColourTexture{})}));
  const Planes by_vertices = rendered(scene), constant = with({0.2, 0.4, 0.6}, false);
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < constant[c].size(); ++i) EXPECT_NEAR(by_vertices[c][i], constant[c][i], 1e-5f);
  EXPECT_EQ(with({0.2, 0.4, 0.6}, true), with({0, 1, 0}, false));
  Material half = Diffuse{};
  half.alpha = scene.add(VertexAlphaTexture{});
  scene.set_material(scene.shapes()[0], scene.add(half));
  EXPECT_EQ(rendered(scene), with(0.5, false)) << "alpha is 1 where colours have none";
}

}  // namespace

}  // namespace alhazen::test
