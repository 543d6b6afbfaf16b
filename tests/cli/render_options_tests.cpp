// Every option of `alhazen render`, tested by its effect on the image and the report.

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <set>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class RenderOptions : public Command {
 protected:
  /// Renders with --stats=json, expects success, and returns the object.
  nlohmann::json statistics(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--stats=json", "--progress", "none"});
    if (std::find(arguments.begin(), arguments.end(), "--spp") == arguments.end())
      arguments.insert(arguments.end(), {"--spp", "2"});
    const CommandResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out);
  }
};

double mean_of(const Image& image, const std::string& channel) {
  const int index = image.channel(channel);
  EXPECT_GE(index, 0) << channel;
  double sum = 0;
  for (const float value : image.planes.at(static_cast<size_t>(index))) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.width * image.height);
}

bool is_same(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels && a.planes == b.planes;
}

/// What it does is tested in aov_surface_tests.cpp.
TEST_F(RenderOptions, AovSurface) {
  for (const char* surface : {"first", "diffuse"})
    EXPECT_EQ(render({"-o", "surface.exr", "--spp", "1", "--aov", "albedo", "--aov-surface", surface}).exit_code, 0);
  const CommandResult unknown = render({"-o", "none.exr", "--aov-surface", "second"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("it may be first, diffuse"), std::string::npos) << unknown.err;
  EXPECT_EQ(render({"-o", "none.exr", "--aov-surface", "diffuse", "--integrator", "iterative"}).exit_code, 2);
  EXPECT_FALSE(exists("none.exr"));
}

TEST_F(RenderOptions, HelpNamesNoneThatIsNotTestedHere) {
  const std::set<std::string> tested{
      "--help", "--output", "--outfile", "--aov", "--exr-type", "--exposure", "--tone-map", "--spp", "--max-depth",
      "--maxdepth", "--size", "--crop", "--cropwindow", "--pixelbounds", "--integrator", "--sampler", "--seed",
      "--backend", "--strategy", "--schedule", "--threads", "--nthreads", "--precision", "--progress", "--quiet",
      "--verbose", "--stats", "--time-limit", "--checkpoint", "--resume", "--overwrite", "--device", "--block",
      "--chunk", "--denoise", "--environment", "--texture-budget", "--coats", "--filter", "--noise", "--guiding",
      "--guiding-memory", "--clamp-indirect", "--aov-surface", "--light-group",
      // Tested in view_tests.cpp:
      "--look-at", "--orbit", "--fit", "--fov", "--aperture", "--focus", "--environment-rotate",
      "--environment-strength", "--light-scale",
      // Tested in display_options_tests.cpp:
      "--white-balance", "--png-depth", "--jpeg-quality",
      // Tested in frames_tests.cpp, turntable_tests.cpp, motion_blur_tests.cpp and standard_streams_tests.cpp:
      "--frames", "--fps", "--turntable", "--shutter", "--format",
      // Tested in layers_tests.cpp:
      "--transparent-background", "--transparent-glass", "--exr-compression", "--exr-parts", "--exr-tiles",
      // Tested in command_line_tests.cpp:
      "--config",
      // Tested in missing_images_tests.cpp:
      "--search-path", "--strict",
      // Tested in help_tests.cpp:
      "--help-all",
      // Tested in quality_tests.cpp:
      "--quality",
      // Tested in gltf_tests.cpp:
      "--camera", "--time", "--animation", "--variant", "--list",
      // Tested in mitsuba_tests.cpp:
      "--define",
      // Tested in live_tests.cpp:
      "--write-every", "--tev", "--terminal",
      // Tested in hostile_input_tests.cpp:
      "--confine"};
  const CommandResult help = run({"render", "--help-all"});
  EXPECT_EQ(help.exit_code, 0);
  std::set<std::string> named;
  for (size_t at = help.out.find("--"); at != std::string::npos; at = help.out.find("--", at + 2)) {
    const size_t end = help.out.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at);
    named.insert(help.out.substr(at, end - at));
  }
  EXPECT_EQ(named, tested);
  for (const char* group :
       {"Output:", "Image:", "Camera:", "Light:", "Scene:", "Animation:", "Engine:", "While it runs:", "SCENE"})
    EXPECT_NE(help.out.find(group), std::string::npos) << group;
}

TEST_F(RenderOptions, TextureBudgetMakesImagesSmaller) {
  Image picture{800, 800, {"R", "G", "B"}, std::vector(3, std::vector<float>(800 * 800, 0.5f))};
  for (size_t i = 0; i < 800 * 800; i += 3) picture.planes[0][i] = 0.25f;
  write_png(folder_.file("picture.png"), source_of(picture), {});
  folder_.write_text("textured.pbrt", R"(Camera "perspective" Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin LightSource "infinite" Texture "t" "spectrum" "imagemap" "string filename" "picture.png"
Material "diffuse" "texture reflectance" "t" Shape "sphere")");
  const std::vector<std::string> whole{"render", "textured.pbrt", "-o", "a.exr", "--spp", "1"};
  EXPECT_EQ(run(whole).err.find("budget"), std::string::npos);
  std::vector<std::string> fitted = whole;
  fitted.insert(fitted.end(), {"--texture-budget", "1"});
  const CommandResult result = run(fitted);
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("more than the budget of 1 MiB; 1 of 1 were made smaller"), std::string::npos)
      << result.err;
  fitted.back() = "0";
  EXPECT_EQ(run(fitted).err.find("budget"), std::string::npos) << "0 is none";
}

/// A rough coat over a white base in a white furnace loses no energy, or as much as in pbrt-v4 on request.
TEST_F(RenderOptions, CoatsLoseLightOnlyWherePbrtsAreAskedFor) {
  folder_.write_text("coat.pbrt", R"(LookAt 0 0 3  0 0 0  0 1 0 Camera "perspective" "float fov" 20
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "coateddiffuse" "rgb reflectance" [ 1 1 1 ] "float roughness" 0.3 "bool remaproughness" false Shape "sphere")");
  const auto mean = [&](const std::string& coats) {
    const CommandResult result =
        run({"render", "coat.pbrt", "-o", "coat.exr", "--spp", "64", "--coats", coats, "--max-depth", "20"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return mean_of(image("coat.exr"), "G");
  };
  EXPECT_NEAR(mean("lossless"), 1, 0.03);
  const double lossy = mean("pbrt");
  EXPECT_LT(lossy, 0.85);
  EXPECT_GT(lossy, 0.5);
  EXPECT_EQ(run({"render", "coat.pbrt", "-o", "no.exr", "--coats", "none"}).exit_code, 2);
}

TEST_F(RenderOptions, PfmHoldsWhatEveryBitOfTheImageIs) {
  const CommandResult result =
      render({"-o", "a.exr", "-o", "a.pfm", "--exr-type", "float", "--spp", "2", "--aov", "depth"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  const Image exr = image("a.exr"), pfm = image("a.pfm");
  for (const char* channel : {"R", "G", "B"})
    EXPECT_EQ(pfm.planes.at(static_cast<size_t>(pfm.channel(channel))),
              exr.planes.at(static_cast<size_t>(exr.channel(channel))))
        << channel;
  EXPECT_EQ(run({"compare", "a.pfm", "a.exr", "--diff", "d.pfm"}).exit_code, 0);
  EXPECT_EQ(image("d.pfm").width, 24);
}

/// The option renders what the same filter in the file does, bit for bit.
TEST_F(RenderOptions, FilterReplacesThatOfTheScene) {
  const std::string scene = R"(LookAt 0 0 4  0 0 0  0 1 0 Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 16 FILTER
WorldBegin LightSource "infinite" "rgb L" [ 1 0.5 0.25 ] Material "diffuse" Shape "sphere")";
  const auto rendered = [&](const std::string& filter, const std::vector<std::string>& options) {
    std::string text = scene;
    text.replace(text.find("FILTER"), 6, filter);
    folder_.write_text("filtered.pbrt", text);
    std::vector<std::string> all{"render", "filtered.pbrt", "-o", "f.pfm", "--spp", "8"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return image("f.pfm");
  };
  const Image own = rendered("PixelFilter \"gaussian\"", {});
  const std::vector<std::pair<std::string, std::string>> filters{
      {"box", R"(PixelFilter "box")"},
      {"triangle", R"(PixelFilter "triangle")"},
      {"mitchell", R"(PixelFilter "mitchell")"},
      {"sinc", R"(PixelFilter "sinc")"},
      {"box,1.25", R"(PixelFilter "box" "float xradius" 1.25 "float yradius" 1.25)"},
      {"gaussian,3", R"(PixelFilter "gaussian" "float xradius" 3 "float yradius" 3)"}};
  for (const auto& [option, directive] : filters) {
    const Image asked = rendered("PixelFilter \"gaussian\"", {"--filter", option});
    EXPECT_TRUE(is_same(asked, rendered(directive, {}))) << option;
    EXPECT_FALSE(is_same(asked, own)) << option;
  }
  for (const char* wrong : {"tent", "box,", "box,0", "box,-1", "box,65", "box,nan", "box,1,2", "Box"})
    EXPECT_EQ(run({"render", "filtered.pbrt", "-o", "no.pfm", "--filter", wrong}).exit_code, 2) << wrong;
  EXPECT_FALSE(exists("no.pfm"));
}

TEST_F(RenderOptions, StatisticsAreOneObjectWithEveryKey) {
  const nlohmann::json j = statistics({"-o", "a.exr", "--seed", "5", "--max-depth", "3", "-t", "2"});
  for (const char* key : {"backend",
                          "strategy",
                          "precision",
                          "schedule",
                          "threads",
                          "integrator",
                          "sampler",
                          "seed",
                          "width",
                          "height",
                          "spp",
                          "max_depth",
                          "triangles",
                          "spheres",
                          "cylinders",
                          "disks",
                          "nodes",
                          "scene_bytes",
                          "load_seconds",
                          "build_seconds",
                          "render_seconds",
                          "camera_samples",
                          "rays",
                          "shadow_rays",
                          "msamples_per_s",
                          "mrays_per_s",
                          "mean_segments",
                          "peak_rss_bytes",
                          "thread_statistics"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_EQ(j["backend"], "openmp");
  EXPECT_EQ(j["precision"], "float");
  EXPECT_EQ(j["threads"], 2);
  EXPECT_EQ(j["seed"], 5);
  EXPECT_EQ(j["width"], 24);
  EXPECT_EQ(j["height"], 24);
  EXPECT_EQ(j["spp"], 2);
  EXPECT_EQ(j["max_depth"], 3);
  EXPECT_EQ(j["triangles"], 36);
  EXPECT_EQ(j["spheres"], 0);
  EXPECT_EQ(j["camera_samples"], 24 * 24 * 2);
  EXPECT_TRUE(j["complete"]);
  EXPECT_GT(j["rays"], 24 * 24 * 2);
  EXPECT_GT(j["shadow_rays"], 0);
  EXPECT_GT(j["render_seconds"], 0.0);
  EXPECT_GT(j["scene_bytes"], 0);
  EXPECT_GT(j["peak_rss_bytes"], 1'000'000);
  EXPECT_GT(j["mean_segments"], 1.0);
  EXPECT_LE(j["mean_segments"], 4.0);
  ASSERT_EQ(j["thread_statistics"].size(), 2u);
  int samples = 0;
  for (const auto& thread : j["thread_statistics"]) {
    EXPECT_GE(thread["busy_seconds"], 0.0);
    samples += thread["samples"].get<int>();
  }
  EXPECT_EQ(samples, 24 * 24 * 2);
}

TEST_F(RenderOptions, TextStatisticsGoToStdout) {
  const CommandResult result = render({"--spp", "1", "-q", "--stats", "-o", "a.png"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.out.find("samples 576"), std::string::npos) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(RenderOptions, OutputsAreAllWritten) {
  EXPECT_EQ(render({"-o", "a.exr", "-o", "b.png", "--output", "c.EXR", "--outfile", "d.exr", "--spp", "2"}).exit_code,
            0);
  const Image a = image("a.exr");
  EXPECT_EQ(a.width, 24);
  EXPECT_EQ(a.height, 24);
  EXPECT_TRUE(is_same(a, image("c.EXR")));
  EXPECT_TRUE(is_same(a, image("d.exr")));
  EXPECT_NEAR(mean_of(a, "R"), mean_of(image("b.png"), "R"), 0.2);
  EXPECT_EQ(folder_.count(), 5u) << "nothing else may be left behind";
}

TEST_F(RenderOptions, TheNameIsTheScenesOwnWhereNoneIsGiven) {
  EXPECT_EQ(render({"--spp", "1"}).exit_code, 0);
  EXPECT_TRUE(exists("cornell.exr"));
  std::string nameless = cornell_box(8);
  nameless.erase(nameless.find("\"string filename\""), std::string("\"string filename\" \"cornell.exr\"").size());
  folder_.write_text("nameless.pbrt", nameless);
  EXPECT_EQ(run({"render", "nameless.pbrt", "--spp", "1"}).exit_code, 0);
  EXPECT_TRUE(exists("nameless.exr"));
}

TEST_F(RenderOptions, ExrHoldsLayersMetadataAndWindows) {
  ASSERT_EQ(render({"-o", "a.exr", "--spp", "3", "--seed", "9", "--aov", "albedo,normal", "--aov",
                    "depth,bounces,samples,variance", "--crop", "0.25,0.75,0.5,1"})
                .exit_code,
            0);
  const Image a = image("a.exr");
  EXPECT_EQ(a.width, 12);
  EXPECT_EQ(a.height, 12);
  for (const char* channel : {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z",
                              "depth.Z", "bounces.Y", "samples.Y", "variance.Y"})
    EXPECT_GE(a.channel(channel), 0) << channel;
  EXPECT_EQ(a.channels.size(), 13u);
  EXPECT_EQ(mean_of(a, "samples.Y"), 3);
  EXPECT_GT(mean_of(a, "depth.Z"), 4);
  EXPECT_LT(mean_of(a, "depth.Z"), 9);
  EXPECT_GE(mean_of(a, "bounces.Y"), 1);
  EXPECT_GT(mean_of(a, "albedo.R"), 0.05);

  const Imf::InputFile file(folder_.file("a.exr").c_str());
  const Imf::Header& header = file.header();
  const auto text = [&](const char* name) {
    const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    EXPECT_NE(attribute, nullptr) << name;
    return attribute ? attribute->value() : std::string();
  };
  EXPECT_EQ(text("scene"), "scene.pbrt");
  EXPECT_EQ(text("seed"), "9");
  EXPECT_EQ(text("samples"), "3");
  EXPECT_NE(text("settings").find("--integrator path"), std::string::npos);
  EXPECT_NE(text("software").find("Alhazen"), std::string::npos);
  EXPECT_GE(std::stod(text("seconds")), 0);
  EXPECT_EQ(header.dataWindow().min.x, 6);
  EXPECT_EQ(header.dataWindow().max.x, 17);
  EXPECT_EQ(header.dataWindow().min.y, 12);
  EXPECT_EQ(header.dataWindow().max.y, 23);
  EXPECT_EQ(header.displayWindow().max.x, 23);
  EXPECT_EQ(header.displayWindow().max.y, 23);
}

TEST_F(RenderOptions, ExrTypeIsHalfOrFloat) {
  ASSERT_EQ(render({"-o", "half.exr", "--spp", "2"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "float.exr", "--spp", "2", "--exr-type", "float"}).exit_code, 0);
  const Image half = image("half.exr"), single = image("float.exr");
  EXPECT_FALSE(is_same(half, single));
  for (size_t i = 0; i < half.planes[0].size(); ++i)
    EXPECT_NEAR(half.planes[0][i], single.planes[0][i], 1e-3f * std::max(1.0f, single.planes[0][i]));
}

TEST_F(RenderOptions, ExposureAndToneMapChangeThePng) {
  ASSERT_EQ(render({"-o", "plain.png", "--spp", "4"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "bright.png", "--spp", "4", "--exposure", "1"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "dark.png", "--spp", "4", "--exposure", "-1.5"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "none.png", "--spp", "4", "--tone-map", "none"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "reinhard.png", "--spp", "4", "--tone-map", "reinhard"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "filmic.png", "--spp", "4", "--tone-map", "filmic"}).exit_code, 0);
  EXPECT_GT(mean_of(image("bright.png"), "R"), mean_of(image("plain.png"), "R"));
  EXPECT_LT(mean_of(image("dark.png"), "R"), mean_of(image("plain.png"), "R"));
  EXPECT_TRUE(is_same(image("none.png"), image("plain.png")));
  EXPECT_LT(mean_of(image("reinhard.png"), "R"), mean_of(image("plain.png"), "R"));
  EXPECT_FALSE(is_same(image("filmic.png"), image("reinhard.png")));
}

TEST_F(RenderOptions, SizeAndParts) {
  ASSERT_EQ(render({"-o", "whole.exr", "--spp", "2", "--size", "20x10"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "crop.exr", "--spp", "2", "--size", "20x10", "--cropwindow", "0.5,1,0,0.5"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "bounds.exr", "--spp", "2", "--size", "20x10", "--pixelbounds", "10,20,0,5"}).exit_code, 0);
  const Image whole = image("whole.exr"), crop = image("crop.exr");
  EXPECT_EQ(whole.width, 20);
  EXPECT_EQ(whole.height, 10);
  ASSERT_EQ(crop.width, 10);
  ASSERT_EQ(crop.height, 5);
  EXPECT_TRUE(is_same(crop, image("bounds.exr")));
  for (size_t y = 0; y < 5; ++y)
    for (size_t x = 0; x < 10; ++x) EXPECT_EQ(crop.planes[0][y * 10 + x], whole.planes[0][y * 20 + x + 10]);
}

TEST_F(RenderOptions, ImageOptionsReachTheRenderer) {
  EXPECT_EQ(statistics({"-o", "a.exr", "--spp", "5"})["spp"], 5);
  EXPECT_EQ(statistics({"-o", "a.exr"})["spp"], 2);
  EXPECT_EQ(statistics({"-o", "a.exr", "--max-depth", "0"})["mean_segments"], 1.0);
  EXPECT_EQ(statistics({"-o", "a.exr", "--maxdepth", "2"})["max_depth"], 2);
  for (const char* integrator : {"path", "iterative", "recursive", "branching"})
    EXPECT_EQ(statistics({"-o", "a.exr", "--integrator", integrator})["integrator"], integrator);
  for (const char* sampler : {"sobol", "independent"})
    EXPECT_EQ(statistics({"-o", "a.exr", "--sampler", sampler})["sampler"], sampler);
  EXPECT_EQ(statistics({"-o", "a.exr", "--seed", "4294967295"})["seed"], 4294967295u);
}

TEST_F(RenderOptions, ANoiseTargetStopsEarlyAndIsReported) {
  const nlohmann::json j = statistics({"-o", "a.exr", "--spp", "400", "--noise", "0.5"});
  EXPECT_EQ(j["complete"], true);
  EXPECT_EQ(j["noise"]["target"], 0.5);
  EXPECT_EQ(j["noise"]["measure"], "relative");
  EXPECT_EQ(j["noise"]["most_spp"], 400);
  EXPECT_LT(j["noise"]["mean_spp"], 400);
  EXPECT_GT(j["noise"]["reached"], 0);
  EXPECT_EQ(statistics({"-o", "a.exr", "--spp", "16", "--noise", "0.5,display"})["noise"]["measure"], "display");
  EXPECT_FALSE(statistics({"-o", "a.exr"}).contains("noise"));
  for (const char* wrong : {"0", "-0.1", "nan", "inf", "2", "x", "", "0.1,", "0.1,seen", "0.1,display,1"}) {
    const CommandResult result = render({"-o", "no.exr", "--noise", wrong});
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_NE(result.err.find("--noise must be a number above 0 and at most 1"), std::string::npos) << result.err;
  }
}

TEST_F(RenderOptions, GuidingLearnsAndIsReported) {
  const nlohmann::json j = statistics({"-o", "a.exr", "--spp", "1100", "--guiding", "on", "--guiding-memory", "8"});
  EXPECT_EQ(j["guiding"]["mode"], "on");
  EXPECT_EQ(j["guiding"]["used"], true);
  EXPECT_GT(j["guiding"]["regions"], 1);
  EXPECT_LE(j["guiding"]["bytes"], 8 << 20);
  EXPECT_FALSE(statistics({"-o", "a.exr"}).contains("guiding"));
  EXPECT_NE(render({"-o", "b.exr", "--spp", "16", "--guiding", "auto"}).err.find("not guided"), std::string::npos);
  const auto refused = [&](std::vector<std::string> options, const char* words) {
    options.insert(options.begin(), {"-o", "no.exr"});
    const CommandResult result = render(options);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  refused({"--guiding", "maybe"}, "unknown mode of guiding 'maybe': it may be off, on, auto");
  refused({"--guiding", "on", "--integrator", "iterative"}, "guiding needs the integrator 'path'");
  for (const char* wrong : {"0", "-1", "x", "1e9", ""})
    refused({"--guiding", "on", "--guiding-memory", wrong},
            "--guiding-memory must be a whole number from 1 to 1048576");
}

TEST_F(RenderOptions, IndirectLightIsLimited) {
  ASSERT_EQ(render({"-o", "all.exr", "--spp", "16"}).exit_code, 0);
  const nlohmann::json j = statistics({"-o", "limited.exr", "--spp", "16", "--clamp-indirect", "0.02"});
  EXPECT_EQ(j["clamp_indirect"], 0.02);
  EXPECT_FALSE(statistics({"-o", "same.exr", "--spp", "16", "--clamp-indirect", "0"}).contains("clamp_indirect"));
  ASSERT_EQ(render({"-o", "direct.exr", "--spp", "16", "--max-depth", "1"}).exit_code, 0);
  ASSERT_EQ(
      render({"-o", "direct_limited.exr", "--spp", "16", "--max-depth", "1", "--clamp-indirect", "0.02"}).exit_code, 0);
  EXPECT_TRUE(is_same(image("all.exr"), image("same.exr")));
  EXPECT_TRUE(is_same(image("direct.exr"), image("direct_limited.exr")));
  const double all = mean_of(image("all.exr"), "G"), limited = mean_of(image("limited.exr"), "G"),
               direct = mean_of(image("direct.exr"), "G");
  EXPECT_LT(limited, all - 0.1 * (all - direct));
  EXPECT_GT(limited, direct);
  const Imf::InputFile file(folder_.file("limited.exr").c_str());
  const auto* settings = file.header().findTypedAttribute<Imf::StringAttribute>("settings");
  ASSERT_NE(settings, nullptr);
  EXPECT_NE(settings->value().find("--clamp-indirect 0.02"), std::string::npos);
  for (const char* wrong : {"-1", "nan", "inf", "x", ""}) EXPECT_EQ(render({"--clamp-indirect", wrong}).exit_code, 2);
  EXPECT_EQ(render({"--clamp-indirect", "1", "--integrator", "iterative"}).exit_code, 2);
}

TEST_F(RenderOptions, SeedsChangeTheNoise) {
  ASSERT_EQ(render({"-o", "a.exr", "--spp", "2"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "b.exr", "--spp", "2", "--seed", "1"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "c.exr", "--spp", "2", "--seed", "0"}).exit_code, 0);
  EXPECT_FALSE(is_same(image("a.exr"), image("b.exr")));
  EXPECT_TRUE(is_same(image("a.exr"), image("c.exr")));
}

TEST_F(RenderOptions, EngineOptionsReachTheBackendAndKeepTheImage) {
  ASSERT_EQ(render({"-o", "serial.exr", "--spp", "2", "--backend", "serial"}).exit_code, 0);
  const Image serial = image("serial.exr");
  for (const char* strategy : {"tiles", "rows", "collapse", "rows+reduction", "reduction"}) {
    const nlohmann::json j = statistics(
        {"-o", "a.exr", "--backend", "openmp", "--strategy", strategy, "--schedule", "guided,2", "--nthreads", "3"});
    EXPECT_EQ(j["backend"], "openmp");
    EXPECT_EQ(j["strategy"], strategy);
    EXPECT_EQ(j["schedule"], "guided,2");
    EXPECT_EQ(j["threads"], 3);
    EXPECT_TRUE(is_same(serial, image("a.exr"))) << strategy;
  }
  for (const char* schedule : {"static", "dynamic,4", "guided"})
    EXPECT_EQ(statistics({"-o", "a.exr", "--schedule", schedule, "--threads", "2"})["schedule"], schedule);
  EXPECT_EQ(statistics({"-o", "a.exr", "-t", "1"})["backend"], "serial");
  EXPECT_EQ(statistics({"-o", "a.exr", "--backend", "auto", "--strategy", "auto", "-t", "2"})["backend"], "openmp");
  EXPECT_GE(statistics({"-o", "a.exr", "-t", "0"})["threads"], 1);
  EXPECT_EQ(statistics({"-o", "d.exr", "--precision", "double"})["precision"], "double");
  EXPECT_EQ(statistics({"-o", "f.exr", "--precision", "float"})["precision"], "float");
  EXPECT_NEAR(mean_of(image("d.exr"), "G"), mean_of(image("f.exr"), "G"), 0.02);
}

TEST_F(RenderOptions, QuietSaysNothingAndVerboseSaysHow) {
  const CommandResult quiet = render({"-o", "a.exr", "--spp", "1", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  const CommandResult verbose = render({"-o", "a.exr", "--spp", "1", "--verbose", "-t", "2"});
  for (const char* word : {"36 triangles", "24 x 24 pixels", "1 samples each", "path in float",
                           "openmp tiles on 2 threads", "wrote a.exr"})
    EXPECT_NE(verbose.err.find(word), std::string::npos) << word << " in\n" << verbose.err;
  EXPECT_EQ(verbose.out, "");
}

TEST_F(RenderOptions, MeshesAloneAndCompressedScenesRender) {
  folder_.write_text("mesh.ply",
                     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_EQ(run({"render", "mesh.ply", "--spp", "1", "--size", "16x16", "-o", "mesh.png"}).exit_code, 0);
  EXPECT_GT(mean_of(image("mesh.png"), "R"), 0.05);
}

}  // namespace

}  // namespace alhazen::impl::test
