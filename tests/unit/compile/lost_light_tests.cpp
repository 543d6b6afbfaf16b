// A warning names light that `path` does not find, with the locations of the light and the glass. If no light is lost
// there is no warning.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compile/compile_scene.h"
#include "io/pbrt/pbrt.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

const std::string floor_of =
    "Material \"diffuse\" \"rgb reflectance\" [.8 .8 .8]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-5 0 -5  5 0 -5  -5 0 5  5 0 5]\n";
const std::string panel = "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n";
const std::string glass = "Material \"dielectric\"\n";
const std::string ball = "AttributeBegin Translate 0 1.5 0 Shape \"sphere\" AttributeEnd\n";
const std::string point = "LightSource \"point\" \"point3 from\" [0 4 0]\n";

struct Case {
  const char* name;
  std::string text;
};

template <class Real>
std::vector<Diagnostics::Warning> warnings_of(const std::string& text, uint32_t path_segments = 9) {
  Diagnostics diagnostics;
  Scene scene = parse_pbrt(text, "test.pbrt", "no-such-folder", diagnostics);
  EXPECT_TRUE(diagnostics.warnings().empty());
  CompileOptions options;
  options.threads = 1;
  options.path_segments = path_segments;
  options.max_copied_triangles = 0;  // instances are not copied
  options.layouts = {BvhLayout::bvh8};
  const CompiledScene<Real> flat = compile_scene<Real>(std::move(scene), options, diagnostics);
  EXPECT_EQ(flat.view.bvh2_nodes_count, 0u);  // trees that were not requested are not kept
  return diagnostics.warnings();
}

template <class Real>
class LostLightOf : public ::testing::Test {};
TYPED_TEST_SUITE(LostLightOf, Reals);

TYPED_TEST(LostLightOf, CausticsOfLightsWithoutSize) {
  const std::string sun = "LightSource \"distant\" \"point3 from\" [0 1 0.1] \"point3 to\" [0 0 0]\n";
  const std::string spot =
      "LightSource \"spot\" \"point3 from\" [0 4 0] \"point3 to\" [0 0 0] \"float coneangle\" 20\n";
  const Case cases[] = {
      {"point", "WorldBegin\n" + point + glass + ball + floor_of},
      {"spot", "WorldBegin\n" + spot + glass + ball + floor_of},
      {"distant", "WorldBegin\n" + sun + glass + ball + floor_of},
      {"a small glass far away",
       "WorldBegin\nLightSource \"point\" \"point3 from\" [0 400 0]\n" + glass +
           "AttributeBegin Translate 3 1.5 2 Shape \"sphere\" \"float radius\" 0.01 AttributeEnd\n" + floor_of},
      {"a glass tube", "WorldBegin\n" + point + glass +
                           "AttributeBegin Translate 0 1.5 0 Shape \"cylinder\" AttributeEnd\n" + floor_of},
      {"pane", "WorldBegin\n" + point +
                   "Material \"thindielectric\"\nAttributeBegin Rotate 90 1 0 0 Shape \"disk\" AttributeEnd\n" +
                   "Translate 0 -1 0 " + floor_of},
      {"small floor behind a large pane",
       "WorldBegin\n" + sun + "AttributeBegin Material \"diffuse\" Scale .5 .5 .5 " + panel +
           "AttributeEnd Material \"thindielectric\" Translate 0 1 0 Scale 9 9 9 " + panel},
      {"small floor behind a thick pane", "WorldBegin\n" + sun + "AttributeBegin Material \"diffuse\" Scale .5 .5 .5 " +
                                              panel + "AttributeEnd\n" + glass + "Translate 0 1 0 Scale 9 9 9 " +
                                              panel + "Translate 0 0.1 0 " + panel},
      {"floor under a thick pane that light meets at 63 degrees",
       "WorldBegin\nLightSource \"point\" \"point3 from\" [-4 3 0]\nAttributeBegin Material \"diffuse\" Translate 2 0 "
       "0 "
       "Scale .2 .2 .2 " +
           panel + "AttributeEnd\n" + glass + "Translate 0 1 0 Scale 9 9 9 " + panel + "Translate 0 0.01 0 " + panel},
      {"bulb", "WorldBegin\n" + point + glass +
                   "AttributeBegin Translate 0 4 0 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n" + floor_of},
      {"moving glass", "WorldBegin\n" + point + glass +
                           "AttributeBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform "
                           "All Translate 0 1.5 0 Shape \"sphere\" AttributeEnd\n" +
                           floor_of},
      {"glass mesh", "WorldBegin\n" + point + glass +
                         "AttributeBegin Translate 0 1.5 0 Scale 1 2 1 Shape \"sphere\" AttributeEnd\n" + floor_of},
      {"glass of index 1", "WorldBegin\n" + point + "Material \"dielectric\" \"float eta\" 1\n" + ball + floor_of},
      {"mix", "WorldBegin\n" + point +
                  "MakeNamedMaterial \"a\" \"string type\" \"dielectric\" MakeNamedMaterial \"b\" \"string "
                  "type\" \"diffuse\"\nMaterial \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.3\n" +
                  ball + floor_of},
      {"behind other glass", "WorldBegin\n" + point + glass + ball +
                                 "AttributeBegin Translate 0 3 0 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n" +
                                 floor_of},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto warnings = warnings_of<TypeParam>(c.text);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].where.line, 2);
    EXPECT_NE(warnings[0].message.find("glass test.pbrt:"), std::string::npos) << warnings[0].message;
    EXPECT_EQ(warnings[0].message.find("that the file asks for"), std::string::npos);
  }
}

TYPED_TEST(LostLightOf, Mirrors) {
  const std::string mirror = "Material \"conductor\" \"rgb reflectance\" [0.9 0.9 0.9] \"float roughness\" 0\n";
  const auto warnings = warnings_of<TypeParam>("WorldBegin\n" + point + mirror + ball + floor_of);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].message.find("point light is lost at the mirror test.pbrt:4:"), std::string::npos)
      << warnings[0].message;
}

TYPED_TEST(LostLightOf, IntegratorsThatWouldFindItAreNamed) {
  for (const std::string kind : {"bdpt", "mlt", "sppm", "lightpath"}) {
    const std::string head = "Integrator \"" + kind + "\" \"integer maxdepth\" 8\nWorldBegin ";
    const auto warnings = warnings_of<TypeParam>(head + point + glass + ball + floor_of);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].message.find("\"" + kind + "\" that the file asks for"), std::string::npos)
        << warnings[0].message;
    EXPECT_TRUE(warnings_of<TypeParam>(head + point + floor_of).empty());
  }
}

TYPED_TEST(LostLightOf, OneWarningForSeveralLights) {
  const std::string text =
      "WorldBegin\n" + point + "LightSource \"point\" \"point3 from\" [1 4 0]\n" +
      "LightSource \"infinite\"\n LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n" + glass +
      ball + floor_of;
  const auto warnings = warnings_of<TypeParam>(text);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].message.find("2 others"), std::string::npos) << warnings[0].message;
}

TYPED_TEST(LostLightOf, LightsThatWereNotLookedAtMayBeMore) {
  for (const auto& [lights, others] : {std::pair{16, "(as for 15 others)"},
                                       {17, "(as for at least 15 others)"},
                                       {100, "(as for at least 15 others)"}}) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < lights; ++i)
      text += "LightSource \"point\" \"point3 from\" [" + std::to_string(i % 10 * 0.1) + " 4 0]\n";
    const auto warnings = warnings_of<TypeParam>(text + glass + ball + floor_of);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].message.find(others), std::string::npos) << warnings[0].message;
  }
}

/// A pane with two instances, among many instances of another object.
TYPED_TEST(LostLightOf, AnyInstanceOfGlassIsFound) {
  const std::string square = "Shape \"bilinearmesh\" \"point3 P\" [-.1 0 -.1  .1 0 -.1  -.1 0 .1  .1 0 .1]\n";
  const std::string panes =
      "AttributeBegin Translate 3 1 2 ObjectInstance \"pane\" AttributeEnd\n"
      "AttributeBegin Translate 2 1 2 ObjectInstance \"pane\" AttributeEnd\n";
  std::string chips;
  for (int i = 0; i < 300; ++i)
    chips +=
        "AttributeBegin Translate " + std::to_string(i * 0.3 - 45) + " 1 -3 ObjectInstance \"chip\" AttributeEnd\n";
  const std::string objects = "Material \"diffuse\"\nObjectBegin \"chip\"\n" + square +
                              "ObjectEnd\nMaterial \"thindielectric\"\nObjectBegin \"pane\"\n" + square + "ObjectEnd\n";
  for (const std::string& instances : {chips + panes, panes + chips}) {
    const auto warnings = warnings_of<TypeParam>("WorldBegin\n" + point + objects + instances + floor_of);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].message.find("glass test.pbrt:9:"), std::string::npos) << warnings[0].message;
  }
  EXPECT_TRUE(warnings_of<TypeParam>("WorldBegin\n" + point + objects + chips + floor_of).empty());
}

TYPED_TEST(LostLightOf, NothingIsSaidWhereNothingIsLost) {
  const std::string lamp =
      "AttributeBegin AreaLightSource \"diffuse\" Translate 0 4 0 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n";
  const Case cases[] = {
      {"no light without size", "WorldBegin\n" + lamp + "LightSource \"infinite\"\n" + glass + ball + floor_of},
      {"no glass", "WorldBegin\n" + point + "Material \"diffuse\"\n" + ball + floor_of},
      {"rough glass", "WorldBegin\n" + point + "Material \"dielectric\" \"float roughness\" 0.3\n" + ball + floor_of},
      {"rough metal", "WorldBegin\n" + point + "Material \"conductor\" \"float roughness\" 0.3\n" + ball + floor_of},
      {"varnish", "WorldBegin\n" + point + "Material \"coateddiffuse\" \"float roughness\" 0\n" + ball + floor_of},
      {"nothing that the light falls on", "WorldBegin\n" + point + glass + ball},
      {"only mirrors that it falls on",
       "WorldBegin\n" + point + glass + ball +
           "Material \"conductor\" \"float roughness\" 0\nShape \"disk\" \"float radius\" 3"},
      {"what it falls on is black",
       "WorldBegin\n" + point + glass + ball +
           "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nShape \"disk\" \"float radius\" 3"},
      {"beside the cone",
       "WorldBegin\nLightSource \"spot\" \"point3 from\" [0 4 0] \"point3 to\" [9 4 0] \"float coneangle\" 20\n" +
           glass + ball + floor_of},
      {"in the shadow", "WorldBegin\n" + point +
                            "Material \"diffuse\"\nAttributeBegin Translate 0 2.8 0 Rotate 90 1 0 0 Shape "
                            "\"disk\" \"float radius\" 4 AttributeEnd\n" +
                            glass + ball + floor_of},
      {"a black light",
       "WorldBegin\nLightSource \"point\" \"rgb I\" [0 0 0] \"point3 from\" [0 4 0]\n" + glass + ball + floor_of},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    for (const Diagnostics::Warning& warning : warnings_of<TypeParam>(c.text)) ADD_FAILURE() << warning.to_string();
  }
  const std::string pane = "AttributeBegin Material \"diffuse\" Scale .1 .1 .1 " + panel +
                           "AttributeEnd Material \"thindielectric\" Translate 0 1 0 Scale 9 9 9 " + panel;
  EXPECT_TRUE(warnings_of<TypeParam>("WorldBegin\n" + point + pane, 2).empty());
  EXPECT_EQ(warnings_of<TypeParam>("WorldBegin\n" + point + pane, 3).size(), 1u);
  // Paths that are too short for any light through glass, and integrators without the check.
  EXPECT_TRUE(warnings_of<TypeParam>("WorldBegin\n" + point + glass + ball + floor_of, 2).empty());
  EXPECT_TRUE(warnings_of<TypeParam>("WorldBegin\n" + point + glass + ball + floor_of, 0).empty());
}

}  // namespace
}  // namespace alhazen::impl::test
