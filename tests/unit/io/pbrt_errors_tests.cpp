// Malformed scenes: the location that each error must report, and the words that it must contain.

#include <filesystem>
#include <fstream>

#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

struct Malformed {
  const char* text;
  const char* place;  ///< line:column
  std::vector<const char*> words;
};

const std::vector<Malformed> malformed{
    // Lexical
    {"WorldBegin\nShape \"sphere", "2:7", {"not closed"}},
    {"WorldBegin\nShape \"sph\nere\"", "2:7", {"not closed"}},
    {"WorldBegin Shape \"a\\qb\"", "1:18", {"escape"}},
    {"WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1", "2:38", {"reflectance", "not closed"}},
    {"WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 [ 1 1 ]", "2:42", {"nested"}},
    {"\xff\xfeW", "1:1", {"UTF-16"}},
    {"  42", "1:3", {"unknown directive", "42"}},
    {"\"Film\"", "1:1", {"expected a directive"}},
    // Directives
    {"Flim \"rgb\"\nWorldBegin", "1:1", {"unknown directive \"Flim\"", "did you mean \"Film\""}},
    {"WorldBegin\n  Shap \"sphere\"", "2:3", {"unknown directive", "\"Shape\""}},
    {"Camera\nWorldBegin", "2:1", {"expected a name", "Camera", "\"WorldBegin\""}},
    {"Film \"rgb\"", "1:1", {"no WorldBegin"}},
    {"", "1:1", {"no WorldBegin"}},
    {"WorldBegin\nWorldBegin", "2:1", {"before WorldBegin"}},
    {"WorldBegin Film \"rgb\"", "1:12", {"Film", "before WorldBegin"}},
    {"Shape \"sphere\" WorldBegin", "1:1", {"Shape", "after WorldBegin"}},
    {"WorldBegin\nAttributeEnd", "2:1", {"AttributeEnd without AttributeBegin"}},
    {"WorldBegin\nAttributeBegin\nAttributeBegin\nAttributeEnd", "2:1", {"AttributeBegin is not closed"}},
    {"WorldBegin\nObjectEnd", "2:1", {"ObjectEnd without ObjectBegin"}},
    {"WorldBegin ObjectBegin \"a\"\nAttributeEnd", "2:1", {"closes the ObjectBegin of line 1"}},
    {"WorldBegin AttributeBegin\nObjectEnd", "2:1", {"closes the AttributeBegin of line 1"}},
    {"WorldBegin\nObjectBegin \"a\"", "2:1", {"ObjectBegin is not closed"}},
    {"WorldBegin ObjectBegin \"a\" ObjectBegin \"b\"", "1:28", {"inside an object"}},
    {"WorldBegin ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd", "2:1", {"\"a\" is defined twice"}},
    {"WorldBegin ObjectBegin \"a\" ObjectInstance \"a\" ObjectEnd", "1:28", {"ObjectInstance inside"}},
    {"WorldBegin\nObjectInstance \"a\"", "2:1", {"object \"a\" is not defined"}},
    {"ColorSpace \"cmyk\" WorldBegin", "1:1", {"unknown colour space", "srgb"}},
    {"Option \"fast\" true", "1:1", {"unknown option \"fast\""}},
    {"Option \"disablepixeljitter\" 3", "1:29", {"true or false"}},
    {"Attribute \"shapes\" \"float radius\" 1", "1:1", {"unknown target"}},
    {"Include \"missing.pbrt\"", "1:1", {"there is no file \"missing.pbrt\""}},
    // Transformations
    {"Translate 1 2 WorldBegin", "1:15", {"expected a number", "WorldBegin"}},
    {"Translate 1 2", "1:14", {"Translate takes 3 numbers", "end of the file"}},
    {"Scale 1 0 1", "1:1", {"not usable"}},
    {"Scale 1e300 1 1 Scale 1e300 1 1", "1:17", {"double precision"}},
    {"Rotate 30 0 0 0", "1:1", {"axis"}},
    {"LookAt 0 0 0 0 0 0 0 1 0", "1:1", {"same point"}},
    {"LookAt 0 0 0 0 0 1 0 0 1", "1:1", {"up vector"}},
    {"Transform 1 0 0 0", "1:11", {"matrix"}},
    {"Transform [ 1 0 0 0 ]", "1:21", {"16 numbers", "got 4"}},
    {"Transform [ 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ]", "1:1", {"cannot be inverted"}},
    {"ActiveTransform Now", "1:17", {"StartTime"}},
    {"CoordSysTransform \"camra\"", "1:1", {"\"camra\" is not defined"}},
    {"TransformTimes 1 1", "1:1", {"later end"}},
    {"Translate nan 0 0", "1:11", {"expected a number"}},
    {"Translate 1e999 0 0", "1:11", {"too large"}},
    {"Translate 1.2.3 0 0", "1:11", {"expected a number"}},
    // Parameters
    {"Film \"rgb\"\n  \"integer xresolutoin\" 10", "2:3", {"unknown parameter \"xresolutoin\"", "\"xresolution\""}},
    {"Film \"rgb\" \"float xresolution\" 10", "1:12", {"expected integer, got float"}},
    {"Camera \"perspective\" \"string fov\" \"wide\"", "1:22", {"expected float, got string"}},
    {"Camera \"perspective\" \"float fov\" \"wide\"", "1:34", {"expected float", "\"wide\""}},
    {"Camera \"perspective\" \"float fov\" [ 30 40 ]", "1:22", {"one value"}},
    {"Camera \"perspective\" \"float fov\" [ ]", "1:22", {"no values"}},
    {"Camera \"perspective\" \"float fov\"", "1:33", {"expected a value", "end of the file"}},
    {"Camera \"perspective\" \"float fov\" 3 \"float fov\" 4", "1:36", {"given twice"}},
    {"Camera \"perspective\" \"fov\" 3", "1:22", {"\"type name\""}},
    {"Camera \"perspective\" \"flaot fov\" 3", "1:22", {"parameter type \"flaot\"", "\"float\""}},
    {"Film \"rgb\" \"integer xresolution\" 1.5", "1:34", {"expected an integer"}},
    {"Film \"rgb\" \"integer xresolution\" 99999999999", "1:34", {"32 bits"}},
    {"Integrator \"path\" \"bool regularize\" maybe", "1:37", {"expected bool"}},
    {"WorldBegin LightSource \"point\" \"point3 from\" [ 1 2 ]", "1:32", {"multiple of 3"}},
    // Options
    {"Film \"rgb\" \"integer xresolution\" 0", "1:12", {"xresolution", "1 to 100000"}},
    {"Film \"rgb\" \"integer yresolution\" [ 100001 ]", "1:12", {"yresolution", "100000"}},
    {"Film \"rgb\" \"integer xresolution\" 100000 \"integer yresolution\" 100000", "1:41", {"10^9"}},
    {"Film \"rgb\" \"integer pixelbounds\" [ 5 5 0 1 ]", "1:12", {"no pixel"}},
    {"Film \"rgb\" \"float cropwindow\" [ 0 1 ]", "1:12", {"four values"}},
    {"Film \"polaroid\"", "1:1", {"unknown film"}},
    {"Film \"image\"", "1:1", {"unknown film", "pbrt-v3", "pbrt --upgrade"}},
    {"Sampler \"02sequence\"", "1:1", {"unknown sampler", "pbrt --upgrade"}},
    {"WorldBegin Material \"matte\"", "1:12", {"unknown material", "pbrt --upgrade"}},
    {"WorldBegin AreaLightSource \"area\"", "1:12", {"unknown area light", "pbrt --upgrade"}},
    {"WorldBegin Texture \"t\" \"color\" \"constant\"", "1:12", {"unknown type", "pbrt --upgrade"}},
    {"Camera \"perspectve\"", "1:1", {"unknown camera"}},
    {"Camera \"perspective\" \"float fov\" 180", "1:22", {"under 180"}},
    {"Camera \"perspective\" \"float shutterclose\" 0", "1:22", {"shutterclose"}},
    {"Sampler \"sobl\"", "1:1", {"unknown sampler", "\"sobol\""}},
    {"Sampler \"sobol\" \"integer pixelsamples\" 0", "1:17", {"at least 1"}},
    {"Integrator \"paht\"", "1:1", {"unknown integrator", "\"path\""}},
    {"PixelFilter \"box\" \"float xradius\" -1", "1:19", {"over 0"}},
    {"PixelFilter \"bx\"", "1:1", {"unknown pixel filter"}},
    // Materials, textures, colours
    {"WorldBegin\nMaterial \"difuse\"", "2:1", {"unknown material \"difuse\"", "\"diffuse\""}},
    {"WorldBegin MakeNamedMaterial \"m\" \"rgb reflectance\" [ 1 1 1 ]", "1:12", {"string type"}},
    {"WorldBegin MakeNamedMaterial \"m\" \"string type\" \"x\"", "1:34", {"unknown material"}},
    {"WorldBegin\nNamedMaterial \"m\"\nShape \"sphere\"", "2:1", {"material \"m\" is not defined"}},
    {"WorldBegin Material \"diffuse\" \"texture reflectance\" \"t\"", "1:31", {"texture \"t\" is not defined"}},
    {"WorldBegin Texture \"t\" \"float\" \"constant\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"",
     "2:20",
     {"spectrum", "float texture"}},
    {"WorldBegin Texture \"t\" \"colour\" \"constant\"", "1:12", {"float or spectrum"}},
    {"WorldBegin Texture \"t\" \"float\" \"imagmap\"", "1:12", {"unknown texture", "\"imagemap\""}},
    {"WorldBegin Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"float\" \"constant\"", "2:1", {"twice"}},
    {"WorldBegin Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 4", "1:47", {"2 or 3"}},
    {"WorldBegin Material \"diffuse\" \"rgb reflectance\" [ 1 1 ]", "1:31", {"three values"}},
    {"WorldBegin Material \"diffuse\" \"rgb reflectance\" [ 1 -1 1 ]", "1:31", {"negative"}},
    {"WorldBegin Material \"diffuse\" \"rgb reflectance\" [ 1 2 1 ]", "1:31", {"over 1"}},
    {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ 400 1 500 ]", "1:31", {"pairs"}},
    {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ 500 1 400 1 ]", "1:31", {"increase"}},
    {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"metal-Xx-eta\"", "1:31", {"no spectrum"}},
    {"WorldBegin LightSource \"point\" \"blackbody I\" -3", "1:32", {"kelvin"}},
    {"WorldBegin Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"rgb k\" [ 1 1 1 ]", "1:33", {"not both"}},
    {"WorldBegin Material \"mix\" \"string materials\" \"a\"", "1:27", {"two names"}},
    // Lights
    {"WorldBegin LightSource \"laser\"", "1:12", {"unknown light"}},
    {"WorldBegin AreaLightSource \"round\"", "1:12", {"unknown area light"}},
    {"WorldBegin LightSource \"distant\" \"point3 to\" [ 0 0 0 ]", "1:34", {"apart"}},
    {"WorldBegin LightSource \"spot\" \"float coneangle\" 0", "1:31", {"coneangle"}},
    {"WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"string filename\" \"x\"", "1:53", {"not both"}},
    // Shapes
    {"WorldBegin\n\tShape \"sphre\"", "2:2", {"unknown shape \"sphre\"", "\"sphere\""}},
    {"WorldBegin Shape \"sphere\" \"float radius\" 0", "1:27", {"over 0"}},
    {"WorldBegin Shape \"sphere\" \"float radius\" -1", "1:27", {"over 0"}},
    {"WorldBegin Shape \"sphere\" \"float zmin\" 2", "1:27", {"zmin"}},
    {"WorldBegin Shape \"disk\" \"float innerradius\" 1", "1:25", {"innerradius"}},
    {"WorldBegin Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ]", "1:12", {"no positions"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 ]",
     "1:66",
     {"multiple of 3"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
     "1:66",
     {"index 3 is out of range", "3 points"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 -1 ]",
     "1:66",
     {"index -1"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 ]", "1:33", {"multiple of 3"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 inf ]", "1:62", {"expected a number"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 ]",
     "1:66",
     {"one per point"}},
    {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 1e39 0 ]",
     "1:80",
     {"too large"}},
    {"WorldBegin Shape \"plymesh\" \"string filename\" \"no.ply\"", "1:28", {"there is no file \"no.ply\""}},
    {"WorldBegin Shape \"plymesh\"", "1:12", {"filename"}},
    {"WorldBegin Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer levels\" 60", "1:64", {"levels"}},
};

TEST(PbrtErrors, EachPointsAtItsPlace) {
  for (const Malformed& c : malformed) {
    SCOPED_TRACE(c.text);
    const std::string message = error_of(c.text);
    const std::string start = std::string("test.pbrt:") + c.place + ": ";
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
    for (const char* word : c.words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
}

TEST(PbrtErrors, ShowTheLineWithACaret) {
  EXPECT_EQ(error_of("WorldBegin\nShape \"sphere\" \"float radius\" -1\n"),
            "test.pbrt:2:16: \"radius\" of Shape \"sphere\" must be over 0\n"
            " 2 | Shape \"sphere\" \"float radius\" -1\n"
            "   |                ^");
}

TEST(PbrtErrors, LongLinesAreCutAroundThePlace) {
  const std::string message =
      error_of("Film \"rgb\" " + std::string(5000, ' ') + "\"float x\" 1" + std::string(5000, ' '));
  EXPECT_LT(message.size(), 400u);
  EXPECT_NE(message.find("\"float x\" 1"), std::string::npos);
}

TEST(PbrtErrors, AMissingSceneFileIsNamed) {
  Diagnostics diagnostics;
  try {
    read_pbrt("no-such-folder/scene.pbrt", diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 27), "no-such-folder/scene.pbrt: ");
  }
}

TEST(PbrtErrors, IncludesThatIncludeThemselvesAreFound) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pbrt_cycle";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.pbrt") << "Include \"b.pbrt\"\n";
  std::ofstream(folder / "b.pbrt") << "# comment\n  Include \"a.pbrt\"\n";
  Diagnostics diagnostics;
  try {
    read_pbrt((folder / "a.pbrt").string(), diagnostics);
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("b.pbrt:2:3: "), std::string::npos) << message;
    EXPECT_NE(message.find("includes itself"), std::string::npos) << message;
  }
}

TEST(PbrtErrors, ErrorsInIncludedFilesNameThem) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pbrt_include_error";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "part.pbrt") << "\n Shape \"ball\"\n";
  const std::string message = error_of("WorldBegin Include \"part.pbrt\"", folder.string());
  EXPECT_NE(message.find("part.pbrt:2:2: unknown shape \"ball\""), std::string::npos) << message;
}

TEST(PbrtErrors, DeepNestingIsRefused) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 10000; ++i) text += "AttributeBegin\n";
  EXPECT_NE(error_of(text).find("over 4096 deep"), std::string::npos);
}

}  // namespace
}  // namespace alhazen::impl::test
