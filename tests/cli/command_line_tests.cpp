// What the command line lets one leave out, options in files, suggestions, and options without effect.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class CommandLine : public Command {
 protected:
  /// One message with all of `words`, and this exit code.
  void expect_error(const std::vector<std::string>& arguments, int exit_code, const std::vector<std::string>& words) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.everything();
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word << result.err;
  }
};

TEST_F(CommandLine, AFileAloneIsRendered) {
  EXPECT_EQ(run({"scene.pbrt", "--spp", "1", "-q", "-o", "a.exr"}).exit_code, 0);
  EXPECT_EQ(run({"--spp", "1", "-q", "-o", "b.exr", "./scene.pbrt"}).exit_code, 0);
  EXPECT_EQ(run({"render", "scene.pbrt", "--spp", "1", "-q", "-o", "c.exr"}).exit_code, 0);
  EXPECT_EQ(image("a.exr").planes, image("c.exr").planes);
  EXPECT_EQ(image("b.exr").planes, image("c.exr").planes);
  expect_error({"absent.pbrt"}, 2, {"absent.pbrt"});
}

TEST_F(CommandLine, SuggestsWhatWasMeant) {
  const auto expect_suggestion = [&](const std::vector<std::string>& arguments, const std::string& name) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("did you mean " + name + "?"), std::string::npos) << result.err;
  };
  expect_suggestion({"render", "scene.pbrt", "--spq", "4"}, "--spp");
  expect_suggestion({"scene.pbrt", "--maxdepht=4"}, "--maxdepth");
  expect_suggestion({"compare", "a.exr", "b.exr", "--jason"}, "--json");
  expect_suggestion({"rendr", "scene.pbrt"}, "render");
  expect_suggestion({"study", "tun", "scene.pbrt"}, "study tune");
  EXPECT_EQ(run({"render", "scene.pbrt", "--magnificent", "4"}).err.find("did you mean"), std::string::npos);
}

TEST_F(CommandLine, NumbersMeanWhatTheySay) {
  const auto statistics = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "scene.pbrt", "-q", "-o", "a.exr", "--stats", "json"});
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out);
  };
  EXPECT_EQ(statistics({"--spp", "1e1"})["spp"], 10);
  EXPECT_EQ(statistics({"--size", "7X5", "--spp", "1"})["width"], 7);
  for (const char* limit : {"100s", "2min", "2m", "0.1h", "1e3"})
    EXPECT_TRUE(statistics({"--spp", "1", "--time-limit", limit})["complete"]) << limit;
  for (const char* limit : {"s", "10 s", "10d", "1e10", "-1s", "10ss"})
    expect_error({"render", "scene.pbrt", "--time-limit", limit}, 2, {"--time-limit", "90s, 1.5min or 2h"});
  for (const char* count : {"1e-1", "1.5e0", "1e99"})
    expect_error({"render", "scene.pbrt", "--spp", count}, 2, {"--spp"});
}

TEST_F(CommandLine, TakesOptionsFromAFile) {
  folder_.write_text(
      "good.toml",
      "# for proofs\nspp = 3\nquiet = true\nverbose = false\n[render]\naov = [\"albedo\", \"normal\"]\nseed = 5\n");
  const auto render_with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "scene.pbrt", "-o", "a.exr", "--stats=json", "--config", "good.toml"});
    return run(more);
  };
  CommandResult result = render_with({});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(only_json(result.out)["spp"], 3);
  EXPECT_EQ(only_json(result.out)["seed"], 5);
  EXPECT_GE(image("a.exr").channel("normal.X"), 0);
  result = render_with({"-ob.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  result = render_with({"--spp=2"});  // the command line counts
  EXPECT_EQ(only_json(result.out)["spp"], 2);
  for (const auto& [text, message] : {std::pair{"sppp = 3", "'sppp' is no option of 'render'"},
                                      {"[compare]\njson = true", "'compare.json'"},
                                      {"quiet = maybe", "true or false"},
                                      {"config = \"other\"", "'config'"},
                                      {"spp = many", "--spp"}}) {
    folder_.write_text("bad.toml", text);
    expect_error({"render", "scene.pbrt", "--config", "bad.toml"}, 2, {message});
  }
  folder_.write_text("other.toml", "orbit = [60, 20]\ndenoise = true\nstats = true\noutput = \"c.exr\"\nspp = 8\n");
  EXPECT_EQ(run({"scene.pbrt", "--config=other.toml", "-q"}).exit_code, 0);
  EXPECT_TRUE(exists("c.exr"));
  EXPECT_EQ(run({"scene.pbrt", "--config=other.toml", "-q", "-od.exr"}).exit_code, 0);
  EXPECT_TRUE(exists("d.exr"));
  expect_error({"render", "scene.pbrt", "--config", "good.toml", "--config", "other.toml"}, 2, {"once"});
  expect_error({"render", "scene.pbrt", "--config="}, 2, {"--config"});
  expect_error({"render", "scene.pbrt", "--config", "absent.toml"}, 2, {"absent.toml", "cannot be read"});
  expect_error({"render", "scene.pbrt", "--config=."}, 2, {"cannot be read"});
  expect_error({"render", "scene.pbrt", "--config"}, 2, {"--config"});
}

TEST_F(CommandLine, SaysWhichOptionsHaveNoEffect) {
  const auto warnings = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "scene.pbrt", "-q", "--spp", "1"});
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return result.err;
  };
  const auto expect_warning = [&](const std::vector<std::string>& arguments, const std::string& option) {
    EXPECT_NE(warnings(arguments).find("--" + option + " has no effect"), std::string::npos) << option;
  };
  expect_warning({"-o", "a.png", "--aov", "albedo"}, "aov");
  expect_warning({"-o", "a.pfm", "--exr-type", "float"}, "exr-type");
  expect_warning({"-o", "a.exr", "--exposure", "1"}, "exposure");
  expect_warning({"-o", "a.exr", "-o", "a.pfm", "--tone-map", "filmic"}, "tone-map");
  expect_warning({"-o", "a.hdr", "--exposure", "auto"}, "exposure");
  expect_warning({"-o", "a.exr", "--white-balance", "auto"}, "white-balance");
  expect_warning({"-o", "a.jpg", "--png-depth", "16"}, "png-depth");
  expect_warning({"-o", "a.png", "--jpeg-quality", "90"}, "jpeg-quality");
  expect_warning({"-o", "a.exr", "--backend", "serial", "--threads", "2"}, "threads");
  EXPECT_EQ(warnings({"-o", "a.exr", "-o", "a.png", "--aov", "albedo", "--exposure", "1", "--tone-map", "filmic",
                      "--exr-type", "float", "--backend", "openmp", "--threads", "2", "--png-depth", "16"}),
            "");
  EXPECT_EQ(warnings({"-o", "a.jpeg", "--exposure", "auto", "--white-balance", "auto", "--jpeg-quality", "90"}), "");
  // Noise is displayed with this exposure.
  EXPECT_EQ(warnings({"-o", "a.exr", "--exposure", "1", "--noise", "0.1,display"}).find("--exposure"),
            std::string::npos);
}

TEST_F(CommandLine, SaysWhereTheImageGoesIfTheSceneAsksForAnotherKind) {
  folder_.write_text("photo.pbrt",
                     "Film \"rgb\" \"string filename\" \"out.tiff\" \"integer xresolution\" 4 \"integer yresolution\" "
                     "4\nWorldBegin\n");
  const CommandResult result = run({"render", "photo.pbrt", "--spp", "1", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("'out.tiff'"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("'photo.exr'"), std::string::npos) << result.err;
  EXPECT_TRUE(exists("photo.exr"));
}

TEST_F(CommandLine, VersionSaysWhatIsBuiltIn) {
  const CommandResult result = run({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("kernels for "), std::string::npos) << result.out;
}

}  // namespace

}  // namespace alhazen::impl::test
