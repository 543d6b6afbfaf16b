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
  expect_error({"render", "scene.pbrt", "--config", "absent.toml"}, 2, {"absent.toml: cannot be opened"});
  expect_error({"render", "scene.pbrt", "--config=."}, 2, {"is a folder"});
  expect_error({"render", "scene.pbrt", "--config"}, 2, {"--config"});
}

TEST_F(CommandLine, NamesTheLineOfAFileWithOptions) {
  for (const auto& [text, message] :
       {std::pair{"checkpoint =\n", "k.cfg:1: 'checkpoint' has no value"},
        {"# a\n\nspp =   # none\n", "k.cfg:3: 'spp' has no value"},
        {"output = \"\"", "k.cfg:1: 'output' has no value"},
        {"aov = []", "k.cfg:1: 'aov' has no value"},
        {"aov = [\"albedo\",", "k.cfg:1: the array of 'aov' has no ]"},
        {"aov = [\"albedo\" \"depth\"]", "k.cfg:1: the values of 'aov' need a comma"},
        {"tone-map = \"aces", "k.cfg:1: the value of 'tone-map' has a quotation mark"},
        {"tone-map = \"aces\" 1", "k.cfg:1: the value of 'tone-map' goes on"},
        {"[render", "k.cfg:1: a section is a name in brackets"},
        {"= 3", "k.cfg:1: this is no option"},
        {"seed = 3\nspp = 2\nseed = 4", "k.cfg:3: 'seed' is given twice, first in line 1"},
        {"spp = 2\nspp = 3", "k.cfg:2: 'spp' is given twice, first in line 1"},
        {"\nspp = abc", "k.cfg:2: --spp must be a whole number"},
        {"\nturntable = abc", "k.cfg:2: --turntable must be a whole number from 1 to 1000000, not 'abc'"},
        {"aov = [\n\"albedo\",\n\"x\"]", "k.cfg:1: unknown layer 'x'"},
        {"backend = x", "k.cfg:1: unknown backend 'x'"},
        {"exr-type = abc", "k.cfg:1: unknown pixel type 'abc'"},
        {"progress = abc", "k.cfg:1: unknown progress 'abc'"},
        {"jpeg-quality = 200", "k.cfg:1: --jpeg-quality"},
        {"exposure = x", "k.cfg:1: --exposure"},
        {"tone-map = x", "k.cfg:1: unknown tone map"},
        {"quiet = maybe", "k.cfg:1: 'quiet' is true or false"}}) {
    folder_.write_text("k.cfg", text);
    const CommandResult result = run({"render", "--config", "k.cfg", "scene.pbrt", "-q"});
    EXPECT_EQ(result.exit_code, 2) << text << result.everything();
    EXPECT_EQ(result.err.find(message), 0u) << message << "\n" << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  }
  // A list, its lines, a mark of the order of bytes, spaces in quotation marks, numbers with commas, Windows' lines.
  folder_.write_text("k.cfg",
                     "\xef\xbb\xbfspp = 1\r\noutput = \"a b#.pfm\"\r\noutput = c.exr\r\naov = [ \"albedo\",  # one\r\n"
                     "  'normal' ]\r\n[render]\r\norbit = 60, 20\r\nquiet\r\n");
  const CommandResult result = run({"render", "--config", "k.cfg", "scene.pbrt"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(exists("a b#.pfm"));
  EXPECT_GE(image("c.exr").channel("normal.X"), 0);
}

TEST_F(CommandLine, AFileWithOptionsIsRegular) {
  CommandOptions options;
  options.folder = folder_.path();
  options.timeout = 20;
  EXPECT_EQ(run_script("mkfifo pipe", options).exit_code, 0);
  for (const auto& [name, message] : {std::pair{"pipe", "pipe: is a pipe, not a regular file"},
                                      {"/dev/zero", "/dev/zero: is a device, not a regular file"}}) {
    const CommandResult result = run({"render", "scene.pbrt", "--config", name}, options);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_EQ(result.err.find(message), 0u) << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  }
}

TEST_F(CommandLine, SaysInItsOwnWordsWhatIsWrongWithAValue) {
  expect_error({"render", "scene.pbrt", "--spp", "1", "--spp", "2"}, 2, {"--spp is given twice: give it once"});
  expect_error({"render", "scene.pbrt", "--fps=1", "--fps=2", "--fps=3"}, 2, {"--fps is given 3 times: give it once"});
  expect_error({"render", "scene.pbrt", "--spp"}, 2, {"--spp needs a value"});
  expect_error({"render", "scene.pbrt", "--turntable", "nan"}, 2,
               {"--turntable must be a whole number from 1 to 1000000, not 'nan'"});
  expect_error({"render", "scene.pbrt", "--exr-tiles", "99999999999"}, 2,
               {"--exr-tiles must be a whole number from 8 to 1024 pixels, or 0 for none, not '99999999999'"});
  expect_error({"render", "scene.pbrt", "--quiet=maybe"}, 2, {"--quiet takes no value"});
  expect_error({"render", "scene.pbrt", "--list=false"}, 2, {"--list takes no value"});
  expect_error({"compare", "a.exr", "b.exr", "--reduce", "x"}, 2,
               {"--reduce must be a whole number from 1 to 4096, not 'x'"});
  expect_error({"study", "tune", "scene.pbrt", "--budget", "nan"}, 2,
               {"--budget must be a finite number from 1 to 1000000, not 'nan'"});
  // What follows is not taken for the value, nor for one more of an option that may be repeated.
  EXPECT_EQ(
      run({"render", "--aov", "albedo", "--aov", "depth", "scene.pbrt", "--spp", "1", "-q", "-o", "a.exr"}).exit_code,
      0);
  expect_error({"render", "--checkpoint=", "scene.pbrt"}, 2, {"--checkpoint needs a value"});
  for (const char* option : {"--frames", "--format", "--exr-type", "--exr-compression", "--progress", "--exposure",
                             "--white-balance", "--tone-map", "--png-depth", "--jpeg-quality", "--spp", "-o"})
    expect_error({"render", "scene.pbrt", option, "", "-q"}, 2, {option == std::string("-o") ? "--output" : option});
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
