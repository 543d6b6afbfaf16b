// The transparent background, and the layers of first points: depth, position, uv, motion, objects and materials.

#include <algorithm>
#include <cmath>
#include <map>

#include "parity/layer_scenes.h"
#include "render/cryptomatte.h"

namespace alhazen::impl::test {

namespace {

Settings transparent() {
  Settings settings = serial();
  settings.transparent_background = true;
  return settings;
}

TEST(Alpha, IsTheCoverageOfThePixel) {
  // The left edge is at a quarter of pixel 4.
  const Scene scene = seen(rectangle(-0.46875, 1, -1, 1));
  const Outcome outcome = render_bits(scene, transparent());
  ASSERT_EQ(outcome.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  const std::vector<double> alpha = plane(outcome, "A"), red = plane(outcome, "R");
  for (size_t y = 0; y < 16; ++y)
    for (size_t x = 0; x < 16; ++x) {
      const size_t i = y * 16 + x;
      EXPECT_NEAR(alpha[i], x < 4 ? 0 : x == 4 ? 0.75 : 1, x == 4 ? 0.07 : 0) << x;
      EXPECT_NEAR(red[i], 0.5 * alpha[i], 1e-5) << "premultiplied, " << x;  // a diffuse surface under a white sky
    }
}

TEST(Alpha, DoesNotChangeWhatIsLit) {
  const Scene scene = seen(rectangle(-1, 1, -1, 1));
  const Outcome opaque = render_bits(scene, serial()), outcome = render_bits(scene, transparent());
  EXPECT_EQ(plane(opaque, "G"), plane(outcome, "G"));
}

TEST(Alpha, LayerLeavesTheBackground) {
  const Outcome outcome = render_bits(seen(rectangle(0, 1, -1, 1)), serial({"alpha"}));
  EXPECT_NEAR(mean(plane(outcome, "alpha.Y")), 0.5, 1e-6);
  EXPECT_NEAR(mean(plane(outcome, "R")), 0.75, 1e-3);
}

TEST(Alpha, OfCutoutsIsTheirOpacity) {
  for (const char* integrator : {"path", "iterative", "recursive", "branching"}) {
    SCOPED_TRACE(integrator);
    Settings settings = transparent();
    settings.integrator = integrator;
    settings.samples_per_pixel = 64;
    const Outcome outcome = render_bits(seen(rectangle(-1, 1, -1, 1, "\"float alpha\" 0.3")), settings);
    EXPECT_NEAR(mean(plane(outcome, "A")), 0.3, 0.01);
  }
}

TEST(Alpha, OfGlassIsOneUnlessItIsTransparent) {
  const Scene pane = seen("Material \"thindielectric\"\n" + rectangle(-1, 1, -1, 1));
  Settings settings = transparent();
  settings.samples_per_pixel = 256;
  const Outcome opaque = render_bits(pane, settings);
  EXPECT_EQ(min(plane(opaque, "A")), 1);
  EXPECT_NEAR(mean(plane(opaque, "R")), 1, 1e-3);
  settings.transparent_glass = true;
  const Outcome glass = render_bits(pane, settings);
  // A pane of index 1.5 reflects 2 * 0.04 / 1.04 of the light.
  EXPECT_NEAR(mean(plane(glass, "A")), 0.0769, 0.005);
  EXPECT_NEAR(mean(plane(glass, "R")), mean(plane(glass, "A")), 1e-5);
}

TEST(Alpha, OfThinGlassOfGltfIsTheSame) {
  Scene scene = seen("Material \"diffuse\"\n" + rectangle(-1, 1, -1, 1));
  const auto constant = [&](double value) {
    scene.textures.emplace_back().value = splat(value);
    return static_cast<uint32_t>(scene.textures.size() - 1);
  };
  Settings settings = transparent();
  settings.transparent_glass = true;
  settings.samples_per_pixel = 256;
  Material glass;
  glass.kind = MaterialKind::principled;
  glass.principled.transmission = constant(1);
  glass.principled.roughness = constant(0);
  scene.materials.at(scene.groups[0].shapes[0].material) = glass;
  EXPECT_NEAR(mean(plane(render_bits(scene, settings), "A")), 0.04, 0.03);
  // Light that leaves diffuse transmission is no background.
  Material leaf;
  leaf.kind = MaterialKind::principled;
  leaf.principled.diffuse_transmission = constant(1);
  scene.materials.at(scene.groups[0].shapes[0].material) = leaf;
  const Outcome outcome = render_bits(scene, settings);
  EXPECT_EQ(min(plane(outcome, "A")), 1);
  EXPECT_GT(mean(plane(outcome, "R")), 0.8);
}

TEST(Alpha, OfMirrorsIsOne) {
  Settings settings = transparent();
  settings.transparent_glass = true;
  const Outcome outcome = render_bits(
      seen("Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0\n" + rectangle(-1, 1, -1, 1)),
      settings);
  EXPECT_EQ(min(plane(outcome, "A")), 1);
  EXPECT_NEAR(mean(plane(outcome, "R")), 1, 1e-3);
}

TEST(Alpha, OfSolidGlassIsWhatItReflects) {
  const Scene ball = seen("Translate 0 4 0\nMaterial \"dielectric\"\nShape \"sphere\" \"float radius\" 0.8\n");
  Settings settings = transparent();
  settings.transparent_glass = true;
  settings.max_depth = 2;  // all that is left is transmitted twice
  settings.samples_per_pixel = 256;
  const std::vector<double> alpha = plane(render_bits(ball, settings), "A");
  EXPECT_NEAR(alpha[8 * 16 + 8], 1 - 0.96 * 0.96, 0.05);
  EXPECT_EQ(alpha[0], 0);
}

TEST(Alpha, StaysBetween0And1WithNegativeFilterWeights) {
  for (const char* guiding : {"off", "on"}) {
    Settings settings = transparent();
    settings.filter = "mitchell";
    settings.guiding = guiding;
    settings.samples_per_pixel = 48;
    const std::vector<double> alpha = plane(render_bits(seen(rectangle(-0.43, 1, -1, 1)), settings), "A");
    EXPECT_GE(min(alpha), 0);
    EXPECT_LE(max(alpha), 1);
    EXPECT_NEAR(mean(alpha), 0.715, 0.01);
  }
}

TEST(Alpha, IsKnownWhereANoiseTargetFinishesPixels) {
  // A black surface has no noise but that of its edge.
  Settings settings = transparent();
  settings.aovs = {"samples"};
  settings.samples_per_pixel = 1024;
  settings.noise = 0.05;
  const std::string black = "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n";
  const Outcome outcome = render_bits(seen(black + rectangle(-0.4375, 1, -1, 1)), settings);
  EXPECT_GE(plane(outcome, "samples.Y")[8 * 16 + 4], 64);  // half covered
  EXPECT_NEAR(plane(outcome, "A")[8 * 16 + 4], 0.5, 0.1);
}

TEST(Alpha, HasTheSameBitsOnEveryEngine) {
  for (const char* name : {"materials", "environments"}) {
    SCOPED_TRACE(name);
    Settings settings = serial(all_aovs);
    settings.aovs.insert(settings.aovs.end(), {"components", "light_groups"});
    settings.transparent_background = settings.transparent_glass = true;
    settings.samples_per_pixel = 9;
    settings.width = 20, settings.height = 14;
    const Outcome expected = render_bits(parity_scene(name), settings);
    visit_engines(settings, [&](const Settings& other) {
      SCOPED_TRACE(other.backend + " " + other.strategy);
      EXPECT_TRUE(same_bits(render_bits(parity_scene(name), other), expected));
    });
  }
}

TEST(Layers, DepthIsAlongTheAxisAndDistanceAlongTheRay) {
  for (const char* precision : {"float", "double"}) {
    Settings settings = serial({"depth", "distance"});
    settings.precision = precision;
    const Outcome outcome = render_bits(seen(rectangle(-2, 2, -2, 2)), settings);
    const std::vector<double> depth = plane(outcome, "depth.Z"), distance = plane(outcome, "distance.Y");
    EXPECT_NEAR(min(depth), 4, 1e-5);
    EXPECT_NEAR(max(depth), 4, 1e-5);
    EXPECT_NEAR(distance[0], 4 * std::sqrt(1 + 2 * std::pow(15.0 / 64, 2)), 1e-3);
    EXPECT_NEAR(min(distance), 4 * std::sqrt(1 + 2 * std::pow(1.0 / 64, 2)), 1e-3);
  }
}

TEST(Layers, AreOfTheFirstSurfaceAndZeroWhereThereIsNone) {
  Settings settings = serial({"depth", "distance", "position", "uv", "object"});
  settings.aov_surface = "diffuse";
  const Outcome outcome = render_bits(seen("AttributeBegin Material \"thindielectric\"\n" + rectangle(-1, 0, -1, 1) +
                                           "AttributeEnd Translate 0 4 0\n" + rectangle(-2, 0, -2, 2)),
                                      settings);
  const size_t left = 8 * 16 + 2, right = 8 * 16 + 13;
  EXPECT_NEAR(plane(outcome, "depth.Z")[left], 4, 1e-4);      // of the pane
  EXPECT_NEAR(plane(outcome, "distance.Y")[left], 3.7, 0.3);  // from the pane to the wall, or of a reflection, 0
  EXPECT_EQ(plane(outcome, "object.Y")[left], 1);
  for (const char* channel : {"depth.Z", "distance.Y", "position.X", "position.Y", "position.Z", "uv.U", "object.Y"})
    EXPECT_EQ(plane(outcome, channel)[right], 0) << channel;
}

TEST(Layers, PositionIsInWorldSpaceAlsoFarFromItsOrigin) {
  for (const double far : {0.0, 65536.0}) {
    SCOPED_TRACE(far);
    // The world begins where the camera is not: the camera's transform translates it.
    const std::string by = std::to_string(far);
    const Outcome outcome = render_bits(scene_of("Scale -1 1 1\nLookAt " + by + " 0 0  " + by + " 1 0  0 0 1\n" +
                                                 R"(Camera "perspective" "float fov" 28.072486935852957
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
WorldBegin
LightSource "infinite"
Translate )" + by + " 0 0\n" + rectangle(-2, 2, -2, 2)),
                                        serial({"position", "depth"}));
    const std::vector<double> x = plane(outcome, "position.X"), y = plane(outcome, "position.Y"),
                              z = plane(outcome, "position.Z");
    EXPECT_NEAR(x[0], far - 15.0 / 16, 0.02);  // right is +x
    EXPECT_NEAR(x[15], far + 15.0 / 16, 0.02);
    EXPECT_NEAR(z[0], 15.0 / 16, 0.02);
    EXPECT_NEAR(z[15 * 16], -15.0 / 16, 0.02);
    EXPECT_NEAR(min(y), 4, 1e-4);
    EXPECT_NEAR(max(y), 4, 1e-4);
    EXPECT_NEAR(max(plane(outcome, "depth.Z")), 4, 1e-4);
  }
}

TEST(Layers, CameraNormalsPointToTheCamera) {
  const Outcome outcome = render_bits(seen(rectangle(-2, 2, -2, 2)), serial({"normal", "camera_normal"}));
  EXPECT_NEAR(mean(plane(outcome, "normal.Y")), -1, 1e-6);
  EXPECT_NEAR(mean(plane(outcome, "camera_normal.X")), 0, 1e-6);
  EXPECT_NEAR(mean(plane(outcome, "camera_normal.Z")), 1, 1e-6);
  // A sphere's normals point to the right on its right, and up at its top.
  const Outcome ball =
      render_bits(seen("Translate 0 4 0\nShape \"sphere\" \"float radius\" 0.9\n"), serial({"camera_normal"}));
  EXPECT_GT(plane(ball, "camera_normal.X")[8 * 16 + 13], 0.5);
  EXPECT_GT(plane(ball, "camera_normal.Y")[2 * 16 + 8], 0.5);
}

TEST(Layers, UvIsInterpolated) {
  const Outcome outcome = render_bits(seen(rectangle(-1, 1, -1, 1)), serial({"uv"}));
  EXPECT_NEAR(plane(outcome, "uv.U")[0], 1.0 / 32, 0.01);
  EXPECT_NEAR(plane(outcome, "uv.V")[0], 31.0 / 32, 0.01);
  EXPECT_NEAR(plane(outcome, "uv.U")[255], 31.0 / 32, 0.01);
}

TEST(Layers, MotionIsInPixelsOverTheShutter) {
  // To the right by 0.5 units, 4 pixels, and up by 0.25, 2 pixels: a sphere's motion, and an instance's.
  const std::string moving = "ActiveTransform EndTime Translate 0.5 0 0.25\nActiveTransform All\n";
  const std::string ball =
      "AttributeBegin " + moving + "Translate 0 4 0\nShape \"sphere\" \"float radius\" 0.3\nAttributeEnd\n";
  const std::string mesh = "AttributeBegin " + moving + rectangle(-0.4, 0.4, -0.4, 0.4) + "AttributeEnd\n";
  for (const std::string& shape : {ball, mesh}) {
    Settings settings = serial({"motion", "alpha"});
    settings.samples_per_pixel = 64;
    const Outcome outcome = render_bits(seen(shape), settings);
    const size_t middle = 6 * 16 + 10;
    ASSERT_GT(plane(outcome, "alpha.Y")[middle], 0.3);
    EXPECT_NEAR(plane(outcome, "motion.X")[middle], 4, 0.4);
    EXPECT_NEAR(plane(outcome, "motion.Y")[middle], 2, 0.3);
    EXPECT_EQ(plane(outcome, "motion.X")[0], 0);
  }
  const Outcome still = render_bits(seen(rectangle(-1, 1, -1, 1)), serial({"motion"}));
  EXPECT_EQ(max(plane(still, "motion.X")), 0);
}

TEST(Layers, MotionNeedsACameraWithAPlane) {
  Scene scene = seen("");
  scene.camera.kind = CameraKind::equirectangular;
  EXPECT_THROW(resolve_settings(serial({"motion"}), scene), InputError);
}

/// The sum of a component's channels over the image.
double sum_of(const Outcome& outcome, const std::string& component) {
  double sum = 0;
  for (const char* channel : {".R", ".G", ".B"}) sum += mean(plane(outcome, component + channel));
  return sum;
}

const std::vector<std::string> components{
    "emission",          "diffuse_direct",      "diffuse_indirect",     "specular_direct",
    "specular_indirect", "transmission_direct", "transmission_indirect"};

TEST(Components, SumToTheImage) {
  for (const char* name : {"materials", "spheres", "environments", "lights"})
    for (const char* guiding : {"off", "on"})
      for (const double limit : {0.0, 0.5}) {
        SCOPED_TRACE(std::string(name) + " guiding " + guiding);
        Settings settings = serial({"components"});
        settings.guiding = guiding;
        settings.clamp_indirect = limit;
        settings.filter = "mitchell";
        settings.samples_per_pixel = 40;
        const Outcome outcome = render_bits(parity_scene(name), settings);
        for (const std::string channel : {"R", "G", "B"}) {
          const std::vector<double> all = plane(outcome, channel);
          std::vector<double> sum(all.size());
          for (const std::string& component : components) {
            const std::vector<double> part = plane(outcome, component + "." + channel);
            for (size_t i = 0; i < all.size(); ++i) sum[i] += part[i];
          }
          for (size_t i = 0; i < all.size(); ++i)
            EXPECT_NEAR(sum[i], all[i], 2e-5 * (1 + std::abs(all[i]))) << channel << " " << i;
        }
      }
}

TEST(Components, OfADiffuseSurfaceUnderTheSkyAreDirect) {
  const Outcome outcome = render_bits(seen(rectangle(-1, 0, -1, 1)), serial({"components"}));
  EXPECT_NEAR(sum_of(outcome, "emission"), 1.5, 1e-3);  // the sky over half of the image
  EXPECT_NEAR(sum_of(outcome, "diffuse_direct"), 0.75, 1e-3);
  for (const char* none :
       {"diffuse_indirect", "specular_direct", "specular_indirect", "transmission_direct", "transmission_indirect"})
    EXPECT_EQ(sum_of(outcome, none), 0) << none;
}

TEST(Components, OfSpecularSurfacesAreByTheSideOfTheLight) {
  Settings settings = serial({"components"});
  settings.samples_per_pixel = 256;
  const Outcome pane = render_bits(seen("Material \"thindielectric\"\n" + rectangle(-1, 1, -1, 1)), settings);
  EXPECT_NEAR(sum_of(pane, "transmission_direct"), 3 * 0.923, 0.03);
  EXPECT_NEAR(sum_of(pane, "specular_direct"), 3 * 0.077, 0.03);
  EXPECT_EQ(sum_of(pane, "diffuse_direct"), 0);
  const Outcome leaf = render_bits(seen(R"(Material "diffusetransmission" "rgb reflectance" [ 0.2 0.2 0.2 ]
"rgb transmittance" [ 0.3 0.3 0.3 ]
)" + rectangle(-1, 1, -1, 1)),
                                   settings);
  EXPECT_NEAR(sum_of(leaf, "diffuse_direct"), 0.6, 0.01);
  EXPECT_NEAR(sum_of(leaf, "transmission_direct"), 0.9, 0.01);
}

TEST(Components, OfLayeredMaterialsAreDiffuseAndSpecular) {
  // A black base leaves the coat alone.
  const auto coated = [](const std::string& colour) {
    Settings settings = serial({"components"});
    settings.samples_per_pixel = 256;
    return render_bits(seen("Material \"coateddiffuse\" \"rgb reflectance\" [ " + colour +
                            " ] \"float roughness\" 0.3\n" + rectangle(-1, 1, -1, 1)),
                       settings);
  };
  const Outcome black = coated("0 0 0"), red = coated("0.8 0 0");
  EXPECT_EQ(sum_of(black, "diffuse_direct"), 0);
  EXPECT_NEAR(sum_of(red, "specular_direct"), sum_of(black, "specular_direct"), 0.01);
  EXPECT_GT(mean(plane(red, "diffuse_direct.R")), 0.3);
  EXPECT_EQ(mean(plane(red, "diffuse_direct.G")), 0);
}

TEST(Components, NeedTheIntegratorPath) {
  Settings settings = serial({"components"});
  settings.integrator = "recursive";
  EXPECT_THROW(resolve_settings(settings, seen("")), InputError);
}

TEST(Cryptomatte, HashesAsMurmurHash3Does) {
  EXPECT_EQ(murmur3_32(""), 0u);
  EXPECT_EQ(murmur3_32("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur3_32("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur3_32("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, IdsAreNormalNumbers) {
  for (const uint32_t hash : {0u, 1u, 0x7f800000u, 0xff800001u, 0x007fffffu, 0x80000000u})
    EXPECT_TRUE(std::isnormal(cryptomatte_id(hash))) << hash;
  EXPECT_EQ(cryptomatte_id(0x3f800000u), 1);
}

TEST(Cryptomatte, CoversPixelsByNamedMaterialsAndInstances) {
  const std::string world = R"(MakeNamedMaterial "clay" "string type" "diffuse"
ObjectBegin "tile"
NamedMaterial "clay"
)" + rectangle(-0.2, 0.2, -0.2, 0.2) +
                            R"(ObjectEnd
AttributeBegin Translate -0.6 0 0 ObjectInstance "tile" AttributeEnd
AttributeBegin Translate 0.6 0 0 ObjectInstance "tile" AttributeEnd
AttributeBegin Translate 0 4 0.6 Shape "sphere" "float radius" 0.3 AttributeEnd
)";
  Scene scene = seen(world);
  Settings settings = serial({"alpha", "object", "material", "cryptomatte"});
  Diagnostics diagnostics;
  const RenderSettings resolved = resolve_settings(settings, scene);
  const Rendering rendering = render_scene(std::move(scene), resolved, 0, {}, diagnostics);
  const Outcome outcome = outcome_of(rendering);
  const auto metadata = rendering.layer_metadata();
  EXPECT_EQ(metadata.at("object"), "{\"sphere.1\":1,\"tile.1\":2,\"tile.2\":3}");
  for (const char* layer : {"CryptoObject", "CryptoMaterial"}) {
    std::vector<double> covered(256);
    for (const char* rank : {"00", "01", "02"})
      for (const char* component : {".G", ".A"}) {
        const std::vector<double> part = plane(outcome, layer + std::string(rank) + component);
        for (size_t i = 0; i < 256; ++i) covered[i] += part[i];
      }
    const std::vector<double> alpha = plane(outcome, "alpha.Y");
    for (size_t i = 0; i < 256; ++i) EXPECT_NEAR(covered[i], alpha[i], 1e-6) << layer << " " << i;
  }
  const size_t on_left = 8 * 16 + 3, on_right = 8 * 16 + 12;
  const std::vector<double> id = plane(outcome, "CryptoObject00.R"), object = plane(outcome, "object.Y");
  EXPECT_EQ(id[on_left], static_cast<double>(cryptomatte_id(murmur3_32("tile.1"))));
  EXPECT_EQ(id[on_right], static_cast<double>(cryptomatte_id(murmur3_32("tile.2"))));
  EXPECT_EQ(object[on_left], 2);
  EXPECT_EQ(object[on_right], 3);
  EXPECT_EQ(plane(outcome, "CryptoMaterial00.R")[on_left], static_cast<double>(cryptomatte_id(murmur3_32("clay"))));
  EXPECT_EQ(id[0], 0);
}

TEST(Cryptomatte, MetadataNamesTheLayerAndWhatIsInTheImage) {
  const auto metadata = cryptomatte_metadata("CryptoObject", {"a \"b\"", "hello"});
  ASSERT_EQ(metadata.size(), 4u);
  for (const auto& [key, value] : metadata) {
    EXPECT_TRUE(key.starts_with("cryptomatte/")) << key;
    EXPECT_EQ(key.rfind('/'), std::string("cryptomatte/0123456").size()) << key;
  }
  const auto ending = [&](const std::string& suffix) {
    for (const auto& [key, value] : metadata)
      if (key.ends_with(suffix)) return value;
    return std::string();
  };
  EXPECT_EQ(ending("/name"), "CryptoObject");
  EXPECT_EQ(ending("/hash"), "MurmurHash3_32");
  EXPECT_EQ(ending("/conversion"), "uint32_to_float32");
  EXPECT_NE(ending("/manifest").find("\"hello\":\"248bfa47\""), std::string::npos) << ending("/manifest");
  EXPECT_NE(ending("/manifest").find("\"a \\\"b\\\"\":"), std::string::npos) << ending("/manifest");
}

}  // namespace

}  // namespace alhazen::impl::test
