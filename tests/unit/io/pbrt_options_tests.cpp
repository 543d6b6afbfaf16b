// Options of pbrt scenes: film, camera, filter, sampler, integrator; syntax of numbers and comments; included files.

#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/math/scalar.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

Parsed parse_options(const std::string& text) {
  return parse(text + "\nWorldBegin Shape \"sphere\" LightSource \"point\"");
}

TEST(PbrtOptions, DefaultsAreThoseOfPbrt) {
  const Parsed p = parse_options("");
  EXPECT_EQ(p.scene.film.width, 1280);
  EXPECT_EQ(p.scene.film.height, 720);
  EXPECT_EQ(p.scene.film.exposure, 1);
  EXPECT_EQ(p.scene.camera.fov, 90);
  EXPECT_EQ(p.scene.filter.type, FilterType::gaussian);
  EXPECT_EQ(p.scene.samples_per_pixel, 16);
  EXPECT_EQ(p.scene.max_depth, 5);
  EXPECT_EQ(p.scene.integrator, IntegratorKind::path);
  EXPECT_TRUE(p.diagnostics.warnings().empty());
}

TEST(PbrtOptions, Film) {
  const Parsed p = parse_options(
      "Film \"rgb\" \"integer xresolution\" [ 40 ] \"integer yresolution\" 30 \"string filename\" \"a.exr\" "
      "\"float iso\" 200 \"integer pixelbounds\" [ 1 20 2 10 ] \"float diagonal\" 20\n"
      "Camera \"perspective\" \"float shutterclose\" 0.25");
  EXPECT_EQ(p.scene.film.width, 40);
  EXPECT_EQ(p.scene.film.height, 30);
  EXPECT_EQ(p.scene.film.filename, "a.exr");
  EXPECT_EQ(p.scene.film.exposure, 0.5);
  EXPECT_EQ(*p.scene.film.pixel_bounds, (std::array<int64_t, 4>{1, 20, 2, 10}));
}

TEST(PbrtOptions, CropWindowIsRoundedUpToPixels) {
  const Parsed p = parse_options(
      "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 10 "
      "\"float cropwindow\" [ 0.25 0.75 0 1.5 ]");
  EXPECT_EQ(*p.scene.film.pixel_bounds, (std::array<int64_t, 4>{3, 8, 0, 10}));
}

TEST(PbrtOptions, FilmsThatAreNotSupported) {
  const Parsed p = parse_options(
      "Film \"spectral\" \"integer nbuckets\" 3 \"string sensor\" \"canon_eos_100d\" "
      "\"float maxcomponentvalue\" 10 \"float whitebalance\" 5000");
  for (const char* word : {"spectral", "sensor", "maxcomponentvalue", "whitebalance"}) EXPECT_TRUE(p.warned(word));
}

TEST(PbrtOptions, Camera) {
  const Parsed p = parse_options(
      "Camera \"perspective\" \"float fov\" 40 \"float screenwindow\" [ -1 2 -3 4 ] \"float frameaspectratio\" 1.5 "
      "\"float lensradius\" 0.1 \"float focaldistance\" 7 \"float shutteropen\" 0.5 \"float shutterclose\" 0.75");
  const Camera& camera = p.scene.camera;
  EXPECT_EQ(camera.fov, 40);
  EXPECT_EQ(*camera.screen_window, (std::array<double, 4>{-1, 2, -3, 4}));
  EXPECT_EQ(*camera.frame_aspect_ratio, 1.5);
  EXPECT_EQ(camera.lens_radius, 0.1);
  EXPECT_EQ(camera.focal_distance, 7);
  EXPECT_EQ(camera.shutter_open, 0.5);
  EXPECT_EQ(camera.shutter_close, 0.75);
}

TEST(PbrtOptions, OtherCameras) {
  const Parsed p = parse_options("Camera \"spherical\" \"string mapping\" \"equirectangular\"");
  EXPECT_EQ(p.scene.camera.kind, CameraKind::equirectangular);
  EXPECT_EQ(parse_options("Camera \"spherical\"").scene.camera.kind, CameraKind::equal_area);
  const Parsed orthographic = parse_options(
      "Camera \"orthographic\" \"float screenwindow\" [ -1 2 -3 4 ] \"float lensradius\" 0.5 \"float focaldistance\" "
      "2");
  EXPECT_EQ(orthographic.scene.camera.kind, CameraKind::orthographic);
  EXPECT_EQ(*orthographic.scene.camera.screen_window, (std::array<double, 4>{-1, 2, -3, 4}));
  EXPECT_EQ(orthographic.scene.camera.lens_radius, 0.5);
  EXPECT_EQ(orthographic.scene.camera.focal_distance, 2);
  for (const Parsed* parsed : {&p, &orthographic}) EXPECT_FALSE(parsed->warned("Camera"));
}

/// A thin biconvex lens: 1 / f = (1.5 - 1) (1 / 50 + 1 / 50), so f = 50 mm; behind it is an aperture stop.
TEST(PbrtOptions, RealisticCameraHasTheFieldOfViewOfItsLens) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pbrt_lens";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "lens.dat") << "# radius thickness eta diameter\n50 0 1.5 20\n-50 0 1 20\n0 40 0 10\n";
  std::ofstream(folder / "bad.dat") << "50 0 1.5 20 7\n";
  const std::string film =
      "Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 400 \"float diagonal\" 50\n";
  const Parsed p = parse(film +
                             "Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float focusdistance\" 1 "
                             "\"float aperturediameter\" 10\nWorldBegin",
                         folder.string());
  EXPECT_TRUE(p.warned("Camera \"realistic\""));
  const double image_distance = 50 * 1000.0 / 950;
  EXPECT_NEAR(p.scene.camera.fov, 2 * std::atan(15 / image_distance) * 180 / pi<double>, 1e-9);
  EXPECT_EQ(p.scene.camera.lens_radius, 0.005);
  EXPECT_EQ(p.scene.camera.focal_distance, 1);
  EXPECT_NEAR(p.scene.film.exposure, pi<double> * 25 / (image_distance * image_distance), 1e-12);
  EXPECT_NE(
      error_of("Camera \"realistic\" \"string lensfile\" \"bad.dat\"\nWorldBegin", folder.string()).find("bad.dat"),
      std::string::npos);
}

TEST(PbrtOptions, Filters) {
  EXPECT_EQ(parse_options("PixelFilter \"box\"").scene.filter.x_radius, 0.5);
  EXPECT_EQ(parse_options("PixelFilter \"triangle\"").scene.filter.y_radius, 2);
  EXPECT_EQ(parse_options("PixelFilter \"sinc\" \"float tau\" 2").scene.filter.tau, 2);
  const Filter mitchell = parse_options("PixelFilter \"mitchell\" \"float B\" 1 \"float C\" 0").scene.filter;
  EXPECT_EQ(mitchell.type, FilterType::mitchell);
  EXPECT_EQ(mitchell.b, 1);
  EXPECT_EQ(mitchell.c, 0);
  const Filter gaussian =
      parse_options("PixelFilter \"gaussian\" \"float sigma\" 0.6 \"float xradius\" 1 \"float yradius\" 3")
          .scene.filter;
  EXPECT_EQ(gaussian.sigma, 0.6);
  EXPECT_EQ(gaussian.x_radius, 1);
  EXPECT_EQ(gaussian.y_radius, 3);
}

TEST(PbrtOptions, Samplers) {
  const Scene independent =
      parse_options("Sampler \"independent\" \"integer pixelsamples\" 9 \"integer seed\" 3").scene;
  EXPECT_EQ(independent.sampler, SamplerType::independent);
  EXPECT_EQ(independent.samples_per_pixel, 9);
  EXPECT_EQ(independent.seed, 3u);
  const Scene stratified =
      parse_options("Option \"seed\" 5 Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 2").scene;
  EXPECT_EQ(stratified.sampler, SamplerType::sobol);
  EXPECT_EQ(stratified.samples_per_pixel, 6);
  EXPECT_EQ(stratified.seed, 5u);
  for (const std::string kind : {"halton", "paddedsobol", "sobol", "zsobol", "pmj02bn"})
    EXPECT_EQ(parse_options("Sampler \"" + kind + "\"").scene.samples_per_pixel, 16);
}

TEST(PbrtOptions, Integrators) {
  for (const std::string kind : {"path", "volpath", "bdpt", "mlt", "sppm", "simplepath", "randomwalk", "lightpath"}) {
    const Parsed p = parse_options("Integrator \"" + kind + "\" \"integer maxdepth\" 7");
    EXPECT_EQ(p.scene.integrator, IntegratorKind::path);
    EXPECT_EQ(p.scene.max_depth, 7);
    EXPECT_TRUE(p.diagnostics.warnings().empty()) << kind;
  }
  EXPECT_TRUE(parse_options("Integrator \"ambientocclusion\"").warned("ambientocclusion"));
  EXPECT_TRUE(parse_options("Integrator \"path\" \"bool regularize\" true").warned("regularize"));
  EXPECT_EQ(parse_options("Integrator \"branching\"").scene.integrator, IntegratorKind::branching);
  EXPECT_EQ(parse_options("Integrator \"recursive\"").scene.integrator, IntegratorKind::recursive);
  EXPECT_EQ(parse_options("Integrator \"iterative\"").scene.integrator, IntegratorKind::iterative);
}

TEST(PbrtOptions, EmptyScenesAreWarnedOf) {
  EXPECT_TRUE(parse("WorldBegin").warned("no shapes and no lights"));
  EXPECT_TRUE(parse_world("Shape \"sphere\"").warned("no lights"));
}

TEST(PbrtSyntax, CommentsEscapesAndNumbers) {
  const Parsed p = parse_world(
      "# \"quotes\" [ in a comment\r\nMaterial \"diffuse\"#not a comment of its own\n\"rgb reflectance\" [.5 1e-1 +.25]"
      "# end\nMakeNamedMaterial \"a \\\"b\\\"\" \"string  type\" \"diffuse\" NamedMaterial \"a \\\"b\\\"\" "
      "Shape \"sphere\" \"float radius\" 5. # no newline at the end");
  EXPECT_EQ(material_of(p, shapes(p)[0]).name, "a \"b\"");
  EXPECT_EQ(shapes(p)[0].radius, 5);
  expect_near(p.scene.textures[p.scene.materials[0].reflectance].value, {0.5, 0.1, 0.25});
}

TEST(PbrtSyntax, NumbersTooSmallForDoublesAreZero) {
  const Parsed p = parse_world("Translate 1e-999 -1e-400 0 Shape \"sphere\"");
  expect_near(shapes(p)[0].world_from_object.start.point({0, 0, 0}), {0, 0, 0}, 0);
}

TEST(PbrtSyntax, ByteOrderMarkIsSkipped) {
  EXPECT_EQ(shapes(parse("\xef\xbb\xbfWorldBegin Shape \"sphere\"")).size(), 1u);
}

std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "parts");
  return folder;
}

void write_gzip(const std::filesystem::path& path, const std::string& text) {
  gzFile file = gzopen(path.string().c_str(), "wb");
  ASSERT_NE(file, nullptr);
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
}

TEST(PbrtFiles, IncludeKeepsTheStateAndImportDoesNot) {
  const std::filesystem::path folder = fresh_folder("pbrt_include");
  std::ofstream(folder / "parts/move.pbrt") << "Translate 1 0 0 Include \"parts/sphere.pbrt\"";
  std::ofstream(folder / "parts/sphere.pbrt") << "Shape \"sphere\"\n";
  std::ofstream(folder / "top.pbrt") << "WorldBegin Import \"parts/move.pbrt\" Shape \"sphere\" "
                                        "Include \"parts/move.pbrt\" Shape \"sphere\"";
  Diagnostics diagnostics;
  const Scene scene = read_pbrt((folder / "top.pbrt").string(), diagnostics);
  const std::vector<Shape>& found = scene.groups[0].shapes;
  ASSERT_EQ(found.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].world_from_object.start.point({0, 0, 0}).x, i == 1 ? 0 : 1) << i;
  EXPECT_EQ(found[0].where.file, (folder / "parts/sphere.pbrt").string());
}

TEST(PbrtFiles, GzipFilesAreReadAsTheyAre) {
  const std::filesystem::path folder = fresh_folder("pbrt_gzip");
  write_gzip(folder / "top.pbrt.gz", "WorldBegin Include \"parts/sphere.pbrt.gz\"");
  write_gzip(folder / "parts/sphere.pbrt.gz", "Shape \"sphere\" \"float radius\" 4");
  Diagnostics diagnostics;
  EXPECT_EQ(read_pbrt((folder / "top.pbrt.gz").string(), diagnostics).groups[0].shapes.at(0).radius, 4);
}

TEST(PbrtFiles, TruncatedGzipIsAnError) {
  const std::filesystem::path folder = fresh_folder("pbrt_truncated");
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 1000; ++i) text += "# line " + std::to_string(i * 7919) + "\n";
  write_gzip(folder / "top.pbrt.gz", text);
  std::filesystem::resize_file(folder / "top.pbrt.gz", std::filesystem::file_size(folder / "top.pbrt.gz") / 2);
  Diagnostics diagnostics;
  EXPECT_THROW(read_pbrt((folder / "top.pbrt.gz").string(), diagnostics), InputError);
}

TEST(PbrtFiles, LargeListsParse) {
  constexpr size_t count = 300'000;
  std::string text = "WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [";
  for (size_t i = 0; i < count; ++i) text += " 0 1 2\n";
  const Parsed p = parse(text + "]");
  EXPECT_EQ(p.scene.meshes.at(0).indices.size(), 3 * count);
  EXPECT_EQ(p.scene.meshes[0].indices.capacity(), 3 * count);
}

/// Scenes beside the source tree, if they are installed there.
std::vector<std::filesystem::path> scenes_beside_the_source() {
  const std::filesystem::path shared = std::filesystem::path(ALHAZEN_SOURCE_DIR) / ".." / "shared";
  std::vector<std::filesystem::path> scenes;
  std::error_code error;
  for (const auto& folder : std::filesystem::directory_iterator(shared / "scenes" / "pbrt", error))
    for (const auto& file : std::filesystem::directory_iterator(folder.path(), error))
      if (file.path().extension() == ".pbrt") scenes.push_back(file.path());
  const std::filesystem::path weekend = shared / "references" / "weekend" / "weekend.pbrt";
  if (std::filesystem::exists(weekend)) scenes.push_back(weekend);
  return scenes;
}

TEST(PbrtFiles, ScenesOfOthersParse) {
  const auto scenes = scenes_beside_the_source();
  if (scenes.empty()) GTEST_SKIP() << "no scenes in ../shared beside the source tree";
  for (const std::filesystem::path& path : scenes) {
    SCOPED_TRACE(path);
    Diagnostics diagnostics;
    try {
      const Scene scene = read_pbrt(path.string(), diagnostics);
      EXPECT_FALSE(scene.groups[0].shapes.empty());
      EXPECT_FALSE(scene.film.filename.empty());
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test
