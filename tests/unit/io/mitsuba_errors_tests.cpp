// Mitsuba scenes that cannot be read: XML that is not well-formed, hostile texts, and objects and values that are
// wrong, each with its location.

#include <algorithm>

#include "support/temporary_folder.h"
#include "unit/io/mitsuba_support.h"

namespace alhazen::impl::test {
namespace {

class MitsubaErrors : public MitsubaTest {};

TEST_F(MitsubaErrors, NameTheirPlaceAndShowTheLine) {
  try {
    parse_content("<shape type=\"sphere\">\n  <float name=\"radios\" value=\"2\"/></shape>");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "s.xml:3:3: the shape 'sphere' has no parameter 'radios'; did you mean \"radius\"?\n"
                 " 3 |   <float name=\"radios\" value=\"2\"/></shape>\n"
                 "   |   ^");
  }
}

TEST_F(MitsubaErrors, OfXml) {
  EXPECT_EQ(mitsuba_error("<scene version=\"3.0.0\">\n<shape></scene>"),
            "s.xml:2:10: this is not well-formed XML: mismatched tag");
  EXPECT_EQ(mitsuba_error(""), "s.xml:1:1: this is not well-formed XML: no element found");
  EXPECT_EQ(mitsuba_error(std::string("<scene version=\"3.0.0\">\0</scene>", 32)),
            "s.xml:1:24: this is not well-formed XML: not well-formed (invalid token)");
  EXPECT_EQ(mitsuba_error("<scene version=\"3.0.0\">text</scene>"),
            "s.xml:1:24: there is text between elements; values are in attributes: value=\"...\"");
  EXPECT_EQ(mitsuba_error("<scene version=\"3.0.0\"><float/>&lt;</scene>"),
            "s.xml:1:32: there is text between elements; values are in attributes: value=\"...\"");
}

TEST_F(MitsubaErrors, OfHostileTexts) {
  const std::string refused = "document type declarations (<!DOCTYPE>) are not supported: remove it";
  EXPECT_EQ(mitsuba_error("<?xml version=\"1.0\"?>\n<!DOCTYPE scene [<!ENTITY a \"aa\"><!ENTITY b \"&a;&a;\">]>\n"
                          "<scene version=\"3.0.0\">&b;</scene>"),
            "s.xml:2:17: " + refused);
  EXPECT_EQ(mitsuba_error("<!DOCTYPE scene SYSTEM \"/etc/passwd\"><scene version=\"3.0.0\"/>"),
            "s.xml:1:37: " + refused);
  std::string deep = "<scene version=\"3.0.0\">";
  for (int i = 0; i < 100000; ++i) deep += "<bsdf type=\"twosided\">";
  EXPECT_EQ(mitsuba_error(deep), "s.xml:1:2818: elements are nested over 128 deep");
}

TEST_F(MitsubaErrors, OfTheRoot) {
  EXPECT_EQ(mitsuba_error("<bsdf version=\"3.0.0\" type=\"diffuse\"/>"),
            "s.xml:1:1: the root element is <bsdf>, not <scene>: this is not a Mitsuba scene");
  EXPECT_EQ(mitsuba_error("<scene/>"), "s.xml:1:1: <scene> lacks its attribute 'version'");
  EXPECT_EQ(mitsuba_error("<scene version=\"new\"/>"), "s.xml:1:1: the version 'new' is not one, such as 3.0.0");
  EXPECT_EQ(mitsuba_error("<scene version=\"4.0.0\"/>"),
            "s.xml:1:1: scenes of version '4.0.0' are unknown; 3 and below are supported");
}

TEST_F(MitsubaErrors, OfElementsAndValues) {
  EXPECT_EQ(content_error("<spehre/>"), "s.xml:2:1: unknown element <spehre>");
  EXPECT_EQ(content_error("<shape type=\"sphere\" colour=\"red\"/>"), "s.xml:2:1: <shape> has no attribute 'colour'");
  EXPECT_EQ(content_error("<shape id=\"a\"/>"), "s.xml:2:1: <shape> lacks its attribute 'type'");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><float name=\"radius\" value=\"big\"/></shape>"),
            "s.xml:2:22: 'radius' must be a finite number, not 'big'");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><float name=\"radius\" value=\"inf\"/></shape>"),
            "s.xml:2:22: 'radius' must be a finite number, not 'inf'");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>"),
            "s.xml:2:22: 'radius' must be over 0");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>"),
            "s.xml:2:22: 'radius' of the shape 'sphere' must be <float>");
  EXPECT_EQ(
      content_error(
          "<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"1\"/></shape>"),
      "s.xml:2:54: 'radius' is given twice");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><integer name=\"radius\" value=\"1.5\"/></shape>"),
            "s.xml:2:22: 'radius' must be a whole number, not '1.5'");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"yes\"/></shape>"),
            "s.xml:2:22: 'flip_normals' must be true or false");
  EXPECT_EQ(content_error("<shape type=\"sphere\"><point name=\"center\" value=\"1 2\"/></shape>"),
            "s.xml:2:22: 'center' takes one or three numbers, not '1 2'");
}

TEST_F(MitsubaErrors, OfKinds) {
  EXPECT_EQ(content_error("<shape type=\"spere\"/>"), "s.xml:2:1: unknown shape 'spere'; did you mean \"sphere\"?");
  EXPECT_EQ(content_error("<bsdf type=\"difuse\"/>"), "s.xml:2:1: unknown BSDF 'difuse'; did you mean \"diffuse\"?");
  EXPECT_EQ(content_error("<emitter type=\"pont\"/>"), "s.xml:2:1: unknown emitter 'pont'; did you mean \"point\"?");
  EXPECT_EQ(content_error("<integrator type=\"paht\"/>"), "s.xml:2:1: unknown integrator 'paht'; use path or direct");
  EXPECT_EQ(content_error("<emitter type=\"area\"/>"), "s.xml:2:1: an area light must be in the shape that emits");
  EXPECT_EQ(
      content_error("<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"wood\"/></bsdf>"),
      "s.xml:2:22: textures of type 'wood' are not supported; use bitmap, checkerboard, mesh_attribute or a colour");
  EXPECT_EQ(content_error("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"cheese\"/></bsdf>").substr(0, 65),
            "s.xml:2:25: no index of refraction is known for 'cheese'; known a");
  EXPECT_EQ(content_error("<bsdf type=\"conductor\"><string name=\"material\" value=\"Xx\"/></bsdf>"),
            "s.xml:2:24: no metal is named 'Xx'; known are Ag, Al, Au, Cu, CuZn, MgO, TiO2, none");
}

TEST_F(MitsubaErrors, OfColours) {
  const auto reflectance = [](const std::string& value) {
    return content_error("<bsdf type=\"diffuse\"><" + value + "/></bsdf>");
  };
  EXPECT_EQ(reflectance("rgb name=\"reflectance\" value=\"1.5\""),
            "s.xml:2:22: 'reflectance': a reflectance cannot be over 1");
  EXPECT_EQ(reflectance("rgb name=\"reflectance\" value=\"-1 0 0\""),
            "s.xml:2:22: 'reflectance': a colour cannot be negative");
  EXPECT_EQ(reflectance("rgb name=\"reflectance\" value=\"1, 2\""),
            "s.xml:2:22: 'reflectance' takes one or three numbers, not '1, 2'");
  EXPECT_EQ(reflectance("spectrum name=\"reflectance\" value=\"400:1, 300:1\""),
            "s.xml:2:22: 'reflectance': the wavelengths must increase from pair to pair");
  EXPECT_EQ(reflectance("srgb name=\"reflectance\" value=\"#12345\""),
            "s.xml:2:22: 'reflectance' must be a colour as #rrggbb, not '#12345'");
}

TEST_F(MitsubaErrors, OfTransforms) {
  const auto transform = [](const std::string& operation) {
    return content_error("<shape type=\"sphere\"><transform name=\"to_world\"><" + operation +
                         "/></transform></shape>");
  };
  EXPECT_EQ(transform("turn x=\"1\""),
            "s.xml:2:49: <turn> is not a transform; use translate, rotate, scale, lookat or matrix");
  EXPECT_EQ(transform("scale value=\"0\""), "s.xml:2:49: a <scale> by 0 leaves nothing: give factors other than 0");
  EXPECT_EQ(transform("rotate angle=\"3\""), "s.xml:2:49: the axis of <rotate> has no length: give x, y or z");
  EXPECT_EQ(transform("rotate x=\"1\""), "s.xml:2:49: <rotate> lacks its attribute 'angle'");
  EXPECT_EQ(transform("matrix value=\"1 2 3\""), "s.xml:2:49: <matrix> takes 16 numbers, or 9, row by row; here are 3");
  EXPECT_EQ(transform("matrix value=\"0 0 0 0 0 0 0 0 0\""),
            "s.xml:2:49: <matrix> is singular: it flattens what it transforms");
  EXPECT_EQ(
      transform("lookat origin=\"0 0 0\" target=\"0 0 0\""),
      "s.xml:2:49: <lookat> has no direction: 'origin' and 'target' must differ, and 'up' must not point along them");
  EXPECT_EQ(transform("scale value=\"1e300\"/><scale value=\"1e300\""),
            "s.xml:2:22: the transform exceeds double precision");
}

TEST_F(MitsubaErrors, OfReferences) {
  EXPECT_EQ(content_error("<shape type=\"sphere\"><ref id=\"a\"/></shape>"), "s.xml:2:22: no object has the id 'a'");
  EXPECT_EQ(content_error("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>"),
            "s.xml:2:30: the id 'a' is used twice; rename one");
  EXPECT_EQ(content_error("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>"),
            "s.xml:2:30: the object contains itself, through its reference to 'a'");
  EXPECT_EQ(content_error(
                "<shape type=\"sphere\"><ref id=\"a\" name=\"x\"/></shape><texture type=\"checkerboard\" id=\"a\"/>"),
            "s.xml:2:22: the shape 'sphere' has no parameter 'x'");
  EXPECT_EQ(content_error("<shape type=\"instance\"/>"),
            "s.xml:2:1: an instance takes one shape of type 'shapegroup', by <ref id=\"...\"/>");
}

/// Parts of a scene that name one another in a row, each before (or after) the one that names it.
std::string tower(size_t count, bool from_below) {
  std::vector<std::string> parts{"<bsdf type=\"diffuse\" id=\"b0\"/>\n"};
  for (size_t i = 1; i < count; ++i)
    parts.push_back("<bsdf type=\"twosided\" id=\"b" + std::to_string(i) + "\"><ref id=\"b" + std::to_string(i - 1) +
                    "\"/></bsdf>\n");
  parts.push_back("<shape type=\"sphere\"><ref id=\"b" + std::to_string(count - 1) + "\"/></shape>\n");
  if (!from_below) std::reverse(parts.begin(), parts.end());
  std::string text;
  for (const std::string& part : parts) text += part;
  return text;
}

TEST_F(MitsubaErrors, OfTowersOfReferencesInBothOrders) {
  const std::string deep = "objects are nested over 128 deep, with those that references name; nest fewer";
  for (const bool from_below : {true, false}) {
    // The scene and the shape are parts of the tower.
    EXPECT_EQ(content_error(tower(126, from_below)), "no error") << from_below;
    EXPECT_NE(content_error(tower(127, from_below)).find(deep), std::string::npos) << from_below;
    EXPECT_NE(content_error(tower(100000, from_below)).find(deep), std::string::npos) << from_below;
  }
}

TEST_F(MitsubaErrors, OfDefaultsThatDouble) {
  const auto doubled = [](int times) {
    std::string text = "<default name=\"a0\" value=\"0123456789abcdef\"/>\n";
    for (int i = 1; i <= times; ++i) {
      const std::string before = "$a" + std::to_string(i - 1);
      text += "<default name=\"a" + std::to_string(i) + "\" value=\"" + before + before + "\"/>\n";
    }
    return text;
  };
  EXPECT_EQ(content_error(doubled(9)), "no error");
  EXPECT_EQ(content_error(doubled(60)),
            "s.xml:19:1: with the values of its parameters ($NAME) an attribute has over 1 MiB; shorten the values");
  std::string many = doubled(16);
  for (int i = 0; i < 64; ++i) many += "<default name=\"c" + std::to_string(i) + "\" value=\"$a16\"/>\n";
  EXPECT_EQ(content_error(many),
            "s.xml:81:1: the attributes with parameters ($NAME) have over 64 MiB in all; use fewer or shorter values");
}

TEST_F(MitsubaErrors, OfMergesThatRepeat) {
  std::string text = "<shape type=\"merge\" id=\"m0\"><shape type=\"cube\"/></shape>\n";
  for (int i = 1; i < 60; ++i) {
    const std::string ref = "<ref id=\"m" + std::to_string(i - 1) + "\"/>";
    text += "<shape type=\"merge\" id=\"m" + std::to_string(i) + "\">" + ref + ref + "</shape>\n";
  }
  const std::string last = "<scene version=\"3.0.0\">\n<shape type=\"merge\"><ref id=\"m59\"/></shape>\n";
  EXPECT_EQ(mitsuba_error(last + text + "</scene>"),
            "s.xml:2:1: the scene has over 10 million shapes, as shapes of type 'merge' repeat others: use instances");
}

TEST_F(MitsubaErrors, OfPrincipledParameters) {
  const auto error_of = [](const std::string& type, const std::string& name, const std::string& value) {
    return content_error("<bsdf type=\"" + type + "\"><float name=\"" + name + "\" value=\"" + value + "\"/></bsdf>");
  };
  for (const char* name : {"roughness", "metallic", "spec_trans", "anisotropic", "clearcoat", "clearcoat_gloss",
                           "sheen", "sheen_tint", "spec_tint", "flatness"}) {
    EXPECT_EQ(error_of("principled", name, "1.5"), "s.xml:2:25: '" + std::string(name) + "' must be from 0 to 1");
    EXPECT_EQ(error_of("principled", name, "1"), "no error") << name;
    EXPECT_NE(error_of("principled", name, "-1"), "no error") << name;
  }
  EXPECT_EQ(error_of("principledthin", "diff_trans", "2"), "no error");
  EXPECT_EQ(error_of("principledthin", "diff_trans", "2.5"), "s.xml:2:29: 'diff_trans' must be from 0 to 2");
}

TEST_F(MitsubaErrors, OfDefinitions) {
  const std::string text = with_sensor("<shape type=\"sphere\"><float name=\"radius\" value=\"$size\"/></shape>");
  EXPECT_EQ(mitsuba_error(text),
            "s.xml:2:22: the parameter '$size' has no value: give -D size=VALUE, or <default "
            "name=\"size\" value=\"...\"/> before this");
  EXPECT_EQ(mitsuba_error(text, {"size=2"}), "no error");
  EXPECT_EQ(mitsuba_error(text, {"size=2", "spp=4"}),
            "s.xml: the scene has no '$spp', which a definition gives a value");
  EXPECT_EQ(mitsuba_error(text, {"size"}), "the definition 'size' is not NAME=VALUE");
}

TEST_F(MitsubaErrors, OfFiles) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& content) {
    return mitsuba_error(with_sensor(content), {}, folder.path());
  };
  EXPECT_EQ(error_of("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>"),
            "s.xml:2:19: there is no file \"a.obj\" (looked for " + folder.file("a.obj") +
                "); paths are relative to the folder of the scene file and to those of <path>; --search-path names "
                "more folders to look in");
  EXPECT_EQ(mitsuba_error(with_sensor("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>"), {},
                          folder.path(), {{folder.path()}, false}),
            "s.xml:2:19: there is no file \"a.obj\" (looked for " + folder.file("a.obj") +
                "); paths are relative to the folder of the scene file and to those of <path>; it is not in a folder "
                "of --search-path either");
  folder.write_text("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(error_of("<shape type=\"obj\"><string name=\"filename\" value=\"b.obj\"/>"
                     "<integer name=\"shape_index\" value=\"0\"/></shape>"),
            "s.xml:2:58: the shape 'obj' has no parameter 'shape_index'");
  EXPECT_EQ(error_of("<shape type=\"obj\"/>"),
            "s.xml:2:1: the shape 'obj' needs <string name=\"filename\" value=\"...\"/>");
  folder.write_text("loop.xml", "<scene version=\"3.0.0\"><include filename=\"loop.xml\"/></scene>");
  EXPECT_EQ(error_of("<include filename=\"loop.xml\"/>"),
            folder.file("loop.xml") + ":1:24: files include each other over 16 deep");
  folder.write_text("bad.serialized", "PK");
  EXPECT_EQ(error_of("<shape type=\"serialized\"><string name=\"filename\" value=\"bad.serialized\"/></shape>"),
            folder.file("bad.serialized") + ": this is not a .serialized file of Mitsuba");
}

TEST_F(MitsubaErrors, OfSensorsAndFilms) {
  const auto error_of = [](const std::string& sensor) {
    return mitsuba_error("<scene version=\"3.0.0\">\n<sensor " + sensor + "</sensor></scene>");
  };
  EXPECT_EQ(error_of("type=\"perspective\"><float name=\"fov\" value=\"180\"/>"),
            "s.xml:2:28: 'fov' must be over 0 and under 180 degrees");
  EXPECT_EQ(error_of("type=\"perspective\"><string name=\"focal_length\" value=\"longmm\"/>"),
            "s.xml:2:28: 'focal_length' must be a finite number, not 'long'");
  EXPECT_EQ(error_of("type=\"thinlens\">"), "s.xml:2:1: the sensor 'thinlens' needs its 'aperture_radius'");
  EXPECT_EQ(
      error_of("type=\"irradiancemeter\">"),
      "s.xml:2:1: sensors of type 'irradiancemeter' are not supported; use perspective, thinlens or orthographic");
  EXPECT_EQ(error_of("type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"0\"/></film>"),
            "s.xml:2:49: 'width' is 0; it must be from 1 to 100000 pixels");
  EXPECT_EQ(error_of("type=\"perspective\"><transform name=\"to_world\"><scale value=\"2\"/></transform>"),
            "s.xml:2:28: the transform of a perspective camera must not scale or shear");
  EXPECT_EQ(
      error_of(
          "type=\"perspective\"><sampler type=\"independent\"><integer name=\"sample_count\" value=\"0\"/></sampler>")
          .substr(0, 49),
      "s.xml:2:56: 'sample_count' must be from 1 to 1677");
}

}  // namespace
}  // namespace alhazen::impl::test
