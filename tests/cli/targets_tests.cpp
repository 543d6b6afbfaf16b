// Targets of images: links, pipes, several in one render, and existing files.

#include <algorithm>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

class OutputTargets : public Command {
 protected:
  bool is_link(const std::string& name) const { return fs::is_symlink(folder_.file(name)); }
  void link(const std::string& target, const std::string& name) const {
    fs::create_symlink(target, folder_.file(name));
  }
  CommandResult script(const std::string& text) const {
    CommandOptions options;
    options.folder = folder_.path();
    return run_script("RENDER=\"$ALHAZEN render scene.pbrt --size 16x16 -t 1\"\n" + wait_for_samples + text, options);
  }
};

TEST_F(OutputTargets, LinksAreFollowed) {
  fs::create_directories(folder_.file("sub/deeper"));
  folder_.write_text("sub/old.exr", "an older image");
  link("sub/old.exr", "old.exr");
  link("sub/new.exr", "new.exr");
  link(folder_.file("absolute.png"), "link.png");
  link("../chained.exr", "sub/deeper/last.exr");
  link("deeper/last.exr", "sub/middle.exr");
  link("sub/middle.exr", "chain.exr");
  fs::create_directory_symlink("sub", folder_.file("folder"));
  const CommandResult result = render({"-o", "old.exr", "-o", "new.exr", "-o", "link.png", "-o", "chain.exr", "-o",
                                       "folder/inside.png", "--spp", "1", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  for (const char* name : {"old.exr", "new.exr", "link.png", "chain.exr"}) EXPECT_TRUE(is_link(name)) << name;
  for (const char* name : {"sub/old.exr", "sub/new.exr", "absolute.png", "sub/chained.exr", "sub/inside.png"}) {
    EXPECT_FALSE(is_link(name)) << name;
    EXPECT_EQ(image(name).width, 24) << name;
  }
}

TEST_F(OutputTargets, EachIsWrittenWhicheverFail) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  link("/dev/full", "first.exr");
  link("/dev/full", "middle.png");
  const CommandResult result =
      render({"-o", "first.exr", "-o", "a.png", "-o", "middle.png", "-o", "b.exr", "--spp", "1", "--stats=json"});
  EXPECT_EQ(result.exit_code, 1) << result.everything();
  EXPECT_EQ(image("a.png").width, 24);
  EXPECT_EQ(image("b.exr").width, 24);
  EXPECT_NE(result.err.find("cannot write first.exr: No space left"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("cannot write middle.png: No space left"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("wrote a.png, b.exr"), std::string::npos) << result.err;
  only_json(result.out);
}

TEST_F(OutputTargets, PipesGetWhatFilesGet) {
  for (const std::string extension : {"png", "exr"}) {
    const CommandResult result = script("mkfifo p." + extension + "; cat p." + extension + " > copy." + extension +
                                        " & sleep 0.2; $RENDER --spp 1 -q -o p." + extension + " -o file." + extension +
                                        "; rc=$?; wait; exit $rc");
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_EQ(image("copy." + extension).planes, image("file." + extension).planes);
  }
}

TEST_F(OutputTargets, APipeWithoutAReaderEndsWithASignal) {
  for (const std::string samples : {"1", "10000000"})
    for (const std::string name : {"TERM", "INT", "HUP"}) {
      const CommandResult result = script("rm -f err p.exr; mkfifo p.exr; $RENDER --spp " + samples +
                                          " --progress json -o p.exr -o a.png 2>err & p=$!\n"
                                          "wait_for_samples; sleep 0.3; kill -" +
                                          name + " $p; wait $p; echo $?; cat err");
      EXPECT_EQ(result.out.substr(0, 2), "1\n") << name << result.everything();
      EXPECT_NE(result.out.find("nobody reads from this pipe"), std::string::npos) << result.out;
      EXPECT_TRUE(exists("a.png")) << "it does not wait for the pipe";
      fs::remove(folder_.file("a.png"));
    }
}

/// Whether there are samples when the signal arrives depends on the machine; a black image is never written.
TEST_F(OutputTargets, InterruptAtTheStartKeepsTheOlderImageOrShowsSomething) {
  const Bytes older = read_file(folder_.write_text("a.exr", "an older image"));
  for (const char* threads : {"1", "64"}) {
    CommandOptions options;
    options.signal_when = [](const std::string& err) {
      return err.find("samples each") != std::string::npos ? SIGTERM : 0;
    };
    const CommandResult result =
        render({"-o", "a.exr", "-v", "--spp", "10000000", "-t", threads, "--progress", "none"}, options);
    if (result.exit_code == 128 + SIGTERM || result.err.find("before the first sample") != std::string::npos) {
      EXPECT_EQ(read_file(folder_.file("a.exr")), older) << result.everything();
      continue;
    }
    EXPECT_EQ(result.exit_code, 130) << result.everything();
    const Image rendered = image("a.exr");
    const std::vector<float>& red = rendered.planes.at(static_cast<size_t>(rendered.channel("R")));
    EXPECT_GT(*std::max_element(red.begin(), red.end()), 0.0f);
    folder_.write("a.exr", older);
  }
}

TEST_F(OutputTargets, KilledItLeavesNothing) {
  folder_.write_text("a.exr", "an older image");
  const size_t files = folder_.count();
  // A pipe instead of the second image keeps the program writing.
  const CommandResult result = script(
      "mkfifo p.exr; $RENDER --spp 1 --progress json -o p.exr -o b.exr --checkpoint state,0 2>err & p=$!\n"
      "wait_for_samples; sleep 0.3; kill -9 $p; wait $p; ls -A | grep -c tmp");
  EXPECT_EQ(result.out, "0\n") << result.everything();
  EXPECT_EQ(folder_.count(), files + 4) << "p.exr, err, b.exr and state";
}

}  // namespace

}  // namespace alhazen::impl::test
