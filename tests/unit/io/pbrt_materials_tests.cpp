// Materials and colours of pbrt scenes.

#include <filesystem>
#include <fstream>

#include "colour/spectrum.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

const std::string sphere = " Shape \"sphere\"\n";

const Material& only_material(const Parsed& p) { return material_of(p, shapes(p).at(0)); }

TEST(PbrtMaterials, DefaultIsHalfDiffuse) {
  const Parsed p = parse_world(sphere);
  EXPECT_EQ(only_material(p).kind, MaterialKind::diffuse);
  expect_near(constant_of(p, only_material(p).reflectance), {0.5, 0.5, 0.5});
}

TEST(PbrtMaterials, Diffuse) {
  const Parsed p = parse_world("Material \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]" + sphere);
  expect_near(constant_of(p, only_material(p).reflectance), {0.1, 0.2, 0.3});
}

/// Our extension.
TEST(PbrtMaterials, RoughDiffuse) {
  const auto diffuse = [](const std::string& roughness) {
    return parse_world("Texture \"map\" \"float\" \"constant\" \"float value\" 0.3 Material \"diffuse\" " + roughness +
                       sphere);
  };
  const Parsed rough = diffuse("\"float roughness\" 0.4"), textured = diffuse("\"texture roughness\" \"map\"");
  EXPECT_EQ(only_material(rough).kind, MaterialKind::oren_nayar);
  expect_near(constant_of(rough, only_material(rough).roughness_u), {0.4, 0.4, 0.4});
  EXPECT_EQ(only_material(textured).kind, MaterialKind::oren_nayar);
  const Parsed smooth = diffuse("\"float roughness\" 0");
  EXPECT_EQ(only_material(smooth).kind, MaterialKind::diffuse);
  EXPECT_EQ(only_material(smooth).roughness_u, no_index);
  for (const char* value : {"-0.1", "1.1"})
    EXPECT_THROW(diffuse(std::string("\"float roughness\" ") + value), InputError) << value;
}

TEST(PbrtMaterials, ConductorOfRgb) {
  const Parsed p = parse_world(
      "Material \"conductor\" \"rgb eta\" [ .2 .9 1.1 ] \"rgb k\" [ 3.9 2.4 2.1 ] \"float uroughness\" 0.1 "
      "\"float vroughness\" [ 0.2 ] \"bool remaproughness\" false" +
      sphere);
  const Material& m = only_material(p);
  EXPECT_EQ(m.kind, MaterialKind::conductor);
  EXPECT_EQ(m.reflectance, no_index);
  expect_near(constant_of(p, m.eta), {0.2, 0.9, 1.1});
  expect_near(constant_of(p, m.k), {3.9, 2.4, 2.1});
  EXPECT_EQ(constant_of(p, m.roughness_u).x, 0.1);
  EXPECT_EQ(constant_of(p, m.roughness_v).x, 0.2);
  EXPECT_FALSE(m.remap_roughness);
}

TEST(PbrtMaterials, ConductorOfSpectraProjectsThemTogether) {
  const Parsed p =
      parse_world("Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" [ \"metal-Ag-k\" ]" +
                  sphere + "Material \"conductor\"" + sphere);
  const ConductorRgb silver = conductor_rgb(*named_spectrum("metal-Ag-eta"), *named_spectrum("metal-Ag-k"));
  const ConductorRgb copper = conductor_rgb(*named_spectrum("metal-Cu-eta"), *named_spectrum("metal-Cu-k"));
  expect_near(constant_of(p, only_material(p).eta), silver.eta);
  expect_near(constant_of(p, only_material(p).k), silver.k);
  const Material& by_default = material_of(p, shapes(p)[1]);
  expect_near(constant_of(p, by_default.eta), copper.eta);
  expect_near(constant_of(p, by_default.k), copper.k);
  EXPECT_EQ(by_default.roughness_u, no_index);
}

TEST(PbrtMaterials, ConductorOfReflectance) {
  const Parsed p =
      parse_world("Material \"conductor\" \"rgb reflectance\" [ .7 .6 .5 ] \"float roughness\" 0.3" + sphere);
  const Material& m = only_material(p);
  expect_near(constant_of(p, m.reflectance), {0.7, 0.6, 0.5});
  EXPECT_EQ(m.eta, no_index);
  EXPECT_EQ(m.k, no_index);
  EXPECT_EQ(m.roughness_u, m.roughness_v);
  EXPECT_TRUE(m.remap_roughness);
}

TEST(PbrtMaterials, Dielectric) {
  const Parsed p = parse_world("Material \"dielectric\" \"float eta\" 1.33" + sphere +
                               "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" \"float roughness\" 0" + sphere +
                               "Material \"dielectric\" \"float vroughness\" 0.5" + sphere);
  EXPECT_EQ(only_material(p).kind, MaterialKind::dielectric);
  EXPECT_EQ(only_material(p).ior, 1.33);
  EXPECT_NEAR(material_of(p, shapes(p)[1]).ior, 1.5168, 1e-3);
  EXPECT_EQ(material_of(p, shapes(p)[1]).roughness_u, no_index);
  EXPECT_TRUE(p.warned("dispersion is not supported"));
  const Material& rough_in_v = material_of(p, shapes(p)[2]);
  EXPECT_EQ(rough_in_v.ior, 1.5);
  EXPECT_EQ(constant_of(p, rough_in_v.roughness_u).x, 0);
  EXPECT_EQ(constant_of(p, rough_in_v.roughness_v).x, 0.5);
}

TEST(PbrtMaterials, NamedOnesMayBeUsedBeforeTheirDefinition) {
  const Parsed p = parse_world("NamedMaterial \"red\"" + sphere +
                               "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 0 0 ]\n"
                               "AttributeBegin Material \"dielectric\" AttributeEnd" +
                               sphere);
  EXPECT_EQ(only_material(p).name, "red");
  expect_near(constant_of(p, only_material(p).reflectance), {1, 0, 0});
  EXPECT_EQ(shapes(p)[0].material, shapes(p)[1].material);
}

TEST(PbrtMaterials, AttributeSetsDefaults) {
  const Parsed p =
      parse_world("AttributeBegin Attribute \"material\" \"rgb reflectance\" [ .1 .1 .1 ] Material \"diffuse\"" +
                  sphere + "Material \"diffuse\" \"rgb reflectance\" [ .2 .2 .2 ]" + sphere +
                  "Attribute \"shape\" \"float radius\" 3" + sphere + "AttributeEnd" + sphere);
  expect_near(constant_of(p, only_material(p).reflectance), {0.1, 0.1, 0.1});
  expect_near(constant_of(p, material_of(p, shapes(p)[1]).reflectance), {0.2, 0.2, 0.2});
  EXPECT_EQ(shapes(p)[2].radius, 3);
  EXPECT_EQ(shapes(p)[3].radius, 1);
}

struct Replacement {
  std::string name, parameters;
  MaterialKind kind;
  double reflectance;
};

TEST(PbrtMaterials, ApproximatedOnesSaySoOnce) {
  const std::vector<Replacement> cases{{"subsurface", "\"float scale\" 2", MaterialKind::coated_diffuse, 0.5},
                                       {"measured", "\"string filename\" \"x.bsdf\"", MaterialKind::diffuse, 0.5},
                                       {"hair", "\"float eumelanin\" 1.3", MaterialKind::diffuse, 0.5}};
  for (const Replacement& c : cases) {
    SCOPED_TRACE(c.name);
    const Parsed p = parse_world("LightSource \"point\" Material \"" + c.name + "\" " + c.parameters + sphere +
                                 "Material \"" + c.name + "\" " + c.parameters + sphere);
    ASSERT_EQ(p.diagnostics.warnings().size(), 1u);
    EXPECT_TRUE(p.warned("test.pbrt:2:21: material \"" + c.name + "\" is not supported"));
    EXPECT_EQ(only_material(p).kind, c.kind);
    expect_near(constant_of(p, only_material(p).reflectance), splat(c.reflectance));
  }
}

TEST(PbrtMaterials, CoatedDiffuse) {
  const Parsed p = parse_world("LightSource \"point\" Material \"coateddiffuse\"" + sphere +
                               "Material \"coateddiffuse\" \"rgb reflectance\" [ .4 .4 .4 ] \"float uroughness\" .1 "
                               "\"float vroughness\" .3 \"float thickness\" 1 \"float eta\" 1.7 \"integer maxdepth\" 5 "
                               "\"integer nsamples\" 2 \"float g\" .1 \"bool remaproughness\" false" +
                               sphere);
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  const Material& plain = only_material(p);
  EXPECT_EQ(plain.kind, MaterialKind::coated_diffuse);
  EXPECT_EQ(plain.ior, 1.5);
  EXPECT_EQ(plain.thickness, 0.01);
  EXPECT_FALSE(plain.thickness_is_given);
  EXPECT_EQ(plain.coat_bounces, 5);
  EXPECT_EQ(plain.roughness_u, no_index);
  expect_near(constant_of(p, plain.reflectance), splat(0.5));
  const Material& other = material_of(p, shapes(p)[1]);
  EXPECT_EQ(other.ior, 1.7);
  EXPECT_EQ(other.thickness, 1);
  EXPECT_TRUE(other.thickness_is_given);
  EXPECT_EQ(other.coat_bounces, 3);
  EXPECT_EQ(constant_of(p, other.roughness_u).x, 0.1);
  EXPECT_EQ(constant_of(p, other.roughness_v).x, 0.3);
  EXPECT_FALSE(other.remap_roughness);
}

TEST(PbrtMaterials, CoatedConductor) {
  const Parsed p = parse_world(
      "LightSource \"point\" Material \"coatedconductor\" \"rgb conductor.eta\" [ 1 2 3 ] \"rgb conductor.k\" "
      "[ 4 5 6 ] \"float conductor.roughness\" 0.2 \"float interface.roughness\" 0.1 \"float interface.eta\" 1.4" +
      sphere);
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  const Material& m = only_material(p);
  EXPECT_EQ(m.kind, MaterialKind::coated_conductor);
  expect_near(constant_of(p, m.eta), {1, 2, 3});
  EXPECT_EQ(constant_of(p, m.roughness_u).x, 0.2);
  EXPECT_EQ(constant_of(p, m.coat_roughness).x, 0.1);
  EXPECT_EQ(m.coat_ior, 1.4);
}

TEST(PbrtMaterials, SheetsAreRead) {
  const Parsed p = parse_world(
      "LightSource \"point\" Material \"diffusetransmission\" \"rgb transmittance\" "
      "[ .4 .4 .4 ]" +
      sphere + "Material \"thindielectric\" \"float eta\" 1.3" + sphere);
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  EXPECT_EQ(only_material(p).kind, MaterialKind::diffuse_transmission);
  expect_near(constant_of(p, only_material(p).reflectance), splat(0.25));
  expect_near(constant_of(p, only_material(p).transmittance), splat(0.4));
  EXPECT_EQ(material_of(p, shapes(p)[1]).kind, MaterialKind::thin_dielectric);
  EXPECT_EQ(material_of(p, shapes(p)[1]).ior, 1.3);
}

TEST(PbrtMaterials, MixesAreOfNamedOnes) {
  const Parsed p = parse_world(
      "LightSource \"point\" Material \"mix\" \"string materials\" [ \"a\" \"c\" ] \"float amount\" .25" + sphere +
      "MakeNamedMaterial \"a\" \"string type\" \"dielectric\" MakeNamedMaterial \"b\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"c\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"b\" ]");
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  const Material& m = only_material(p);
  EXPECT_EQ(m.kind, MaterialKind::mix);
  EXPECT_EQ(constant_of(p, m.amount).x, 0.25);
  EXPECT_EQ(p.scene.materials[m.mixed[0]].kind, MaterialKind::dielectric);
  EXPECT_EQ(p.scene.materials[m.mixed[1]].kind, MaterialKind::mix);
}

TEST(PbrtMaterials, MixesWithNothingLetRaysThrough) {
  const Parsed p = parse_world(
      "MakeNamedMaterial \"a\" \"string type\" \"dielectric\" MakeNamedMaterial \"b\" \"string type\" "
      "\"interface\"\nMaterial \"mix\" \"string materials\" [ \"b\" \"a\" ] \"float amount\" .25" +
      sphere);
  EXPECT_EQ(only_material(p).kind, MaterialKind::dielectric);
  EXPECT_EQ(constant_of(p, only_material(p).alpha).x, 0.25);
}

TEST(PbrtMaterials, BumpsAreRead) {
  const Parsed p = parse_world(
      "LightSource \"point\" Texture \"d\" \"float\" \"wrinkled\" Material \"diffuse\" "
      "\"texture displacement\" \"d\"" +
      sphere);
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  EXPECT_NE(only_material(p).displacement, no_index);
}

TEST(PbrtMaterials, InterfacesAreOmitted) {
  for (const std::string kind : {"interface", ""}) {
    const Parsed p = parse_world("Material \"" + kind + "\"" + sphere + "Material \"diffuse\"" + sphere);
    EXPECT_EQ(shapes(p).size(), 1u);
    EXPECT_TRUE(p.warned("omitted"));
  }
}

TEST(PbrtMaterials, AbsorbingMediaInsideDielectrics) {
  const std::string medium =
      "LightSource \"point\" MakeNamedMedium \"tea\" \"string type\" \"homogeneous\" "
      "\"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 0 0 0 ] \"float scale\" 2\n";
  const Parsed p = parse_world(medium + "MediumInterface \"tea\" \"\" Material \"dielectric\"" + sphere);
  EXPECT_EQ(p.diagnostics.warnings().size(), 0u);
  expect_near(only_material(p).absorption, {2, 4, 6});
  const Parsed opaque = parse_world(medium + "MediumInterface \"tea\" \"\" Material \"diffuse\"" + sphere);
  EXPECT_TRUE(opaque.warned("not a dielectric"));
}

TEST(PbrtMaterials, MediaAreWarnedOf) {
  const Parsed p = parse_world(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ]\n"
      "MediumInterface \"fog\" \"\" MediumInterface \"fog\"" +
      sphere);
  EXPECT_TRUE(p.warned("participating media are not supported"));
}

// --- colours

TEST(PbrtColours, SpectraAreProjected) {
  const Parsed p = parse_world("Material \"diffuse\" \"spectrum reflectance\" [ 400 0.2 700 0.8 ]" + sphere);
  expect_near(constant_of(p, only_material(p).reflectance), reflectance_rgb({{400, 700}, {0.2, 0.8}}));
}

TEST(PbrtColours, LightsTakeNormalisedSpectraAndPlainRgb) {
  const Parsed p = parse_world(
      "LightSource \"point\" \"blackbody I\" 3000 \"float scale\" 2\nLightSource \"point\" \"rgb I\" [ 1 2 3 ]\n"
      "LightSource \"point\" \"spectrum I\" [ 360 5 830 5 ]\nLightSource \"point\" \"spectrum I\" \"stdillum-D65\"");
  expect_near(p.scene.lights[0].radiance, illuminant_rgb(blackbody_spectrum(3000)) * 2.0);
  expect_near(p.scene.lights[1].radiance, {1, 2, 3});
  expect_near(p.scene.lights[2].radiance, illuminant_rgb({{360, 830}, {5, 5}}));
  expect_near(p.scene.lights[3].radiance, illuminant_rgb(*named_spectrum("stdillum-D65")));
}

TEST(PbrtColours, SpectrumFilesAreRelativeToTheScene) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pbrt_spd";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "flat.spd") << "360 0.25\n830 0.25\n";
  const Parsed p = parse_world("Material \"diffuse\" \"spectrum reflectance\" \"flat.spd\"" + sphere, folder.string());
  expect_near(constant_of(p, only_material(p).reflectance), reflectance_rgb({{360, 830}, {0.25, 0.25}}));
}

TEST(PbrtColours, OtherColourSpacesKeepWhiteAndTheirPrimariesLeaveTheGamut) {
  for (const std::string space : {"rec2020", "aces2065-1", "dci-p3"}) {
    SCOPED_TRACE(space);
    const Parsed p = parse_world("ColorSpace \"" + space +
                                 "\" LightSource \"point\" \"rgb I\" [ 1 1 1 ] "
                                 "LightSource \"point\" \"rgb I\" [ 1 0 0 ]");
    expect_near(p.scene.lights[0].radiance, {1, 1, 1}, 1e-9);
    EXPECT_GT(p.scene.lights[1].radiance.x, 1.05);
    EXPECT_LT(p.scene.lights[1].radiance.y, 0);
  }
}

TEST(PbrtColours, Rec2020MatchesThePublishedMatrix) {
  // ITU-R BT.2087-0, from BT.2020 to BT.709, rounded to four digits there.
  const Parsed p = parse_world("ColorSpace \"rec2020\" LightSource \"point\" \"rgb I\" [ 0 1 0 ]");
  expect_near(p.scene.lights[0].radiance, {-0.5876, 1.1329, -0.1006}, 1e-4);
}

TEST(PbrtColours, XyzOfD65IsWhite) {
  const Parsed p = parse_world("LightSource \"point\" \"xyz I\" [ 0.950456 1 1.089058 ]");
  expect_near(p.scene.lights[0].radiance, {1, 1, 1}, 1e-5);
}

}  // namespace
}  // namespace alhazen::impl::test
