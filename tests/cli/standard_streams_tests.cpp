// `alhazen render -` reads a scene from standard input, and `-o -` writes an image to standard output.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class StandardStreams : public Command {
 protected:
  CommandResult script(const std::string& text) const {
    CommandOptions options;
    options.folder = folder_.path();
    return run_script(text, options);
  }
  Bytes bytes(const std::string& name) const { return read_file(folder_.file(name)); }
};

TEST_F(StandardStreams, HaveTheBitsOfFiles) {
  ASSERT_EQ(render({"-o", "a.png", "-o", "a.pfm", "--spp", "2", "-q"}).exit_code, 0);
  const CommandResult png = script("cat scene.pbrt | $ALHAZEN render - -o - --spp 2 > b.png");
  EXPECT_EQ(png.exit_code, 0) << png.everything();
  EXPECT_NE(png.err.find("wrote standard output"), std::string::npos) << png.err;
  EXPECT_EQ(image("b.png").planes, image("a.png").planes);  // the text in them names the scene
  ASSERT_EQ(script("$ALHAZEN render scene.pbrt -q -o - --format pfm --spp 2 | cat > b.pfm").exit_code, 0);
  EXPECT_EQ(bytes("b.pfm"), bytes("a.pfm"));
  ASSERT_EQ(script("$ALHAZEN render - -q -o - --format exr -o c.png --spp 2 < scene.pbrt > b.exr").exit_code, 0);
  EXPECT_EQ(image("b.exr").width, 24);
  EXPECT_EQ(image("c.png").planes, image("a.png").planes);
}

TEST_F(StandardStreams, NamesInASceneAreRelativeToTheWorkingFolder) {
  std::filesystem::create_directory(folder_.file("parts"));
  std::filesystem::rename(folder_.file("scene.pbrt"), folder_.file("parts/cornell.pbrt"));
  EXPECT_EQ(script("echo 'Include \"parts/cornell.pbrt\"' | $ALHAZEN render - -q --spp 1 -o a.png").exit_code, 0);
  const CommandResult confined =
      script("echo 'Include \"../cornell.pbrt\"' | $ALHAZEN render - --confine -q --spp 1 -o b.png");
  EXPECT_EQ(confined.exit_code, 2);
  EXPECT_NE(confined.err.find("confined"), std::string::npos) << confined.err;
  const CommandResult bad = script("printf 'WorldBegin\\nShape \"cube\"' | $ALHAZEN render - -o b.png");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("standard input:2:"), std::string::npos) << bad.err;
}

/// A name is chosen for the image where neither the options nor the scene gives one.
TEST_F(StandardStreams, ASceneFromStandardInputHasADefaultName) {
  ASSERT_EQ(
      script("grep -v filename scene.pbrt | sed 's/\"string filename\" \"[^\"]*\"//' | $ALHAZEN render - -q --spp 1")
          .exit_code,
      0);
  EXPECT_TRUE(exists("stdin.exr"));
}

TEST_F(StandardStreams, RefuseWhatMakesNoSense) {
  const auto refused = [&](const std::string& command, const std::string& word) {
    const CommandResult result = script(command);
    EXPECT_EQ(result.exit_code, 2) << command << result.everything();
    EXPECT_NE(result.err.find(word), std::string::npos) << command << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused("$ALHAZEN render - -o a.png < /dev/null", "standard input is empty");
  refused("$ALHAZEN render - -o a.png <&-", "standard input");
  refused("printf 'glTF....' | $ALHAZEN render - -o a.png", "give other files by their names");
  refused("$ALHAZEN render scene.pbrt -o - --stats | cat > x; exit 2", "--stats");
  refused("$ALHAZEN render scene.pbrt -o - --format tiff", "--format");
  refused("$ALHAZEN render scene.pbrt -o a.png --format png", "--format is for -o -");
  refused("$ALHAZEN render scene.pbrt -o - -o -", "another output");
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(StandardStreams, AReaderThatIsGoneIsAnError) {
  const CommandResult result = script(
      "mkfifo p; (exec 3< p; sleep 0.1) & $ALHAZEN render scene.pbrt -q --size 200x200 --spp 8 -o - > p; echo $?");
  EXPECT_EQ(result.out, "1\n") << result.everything();
  EXPECT_NE(result.err.find("cannot write to standard output: Broken pipe"), std::string::npos) << result.err;
  const CommandResult full = script("$ALHAZEN render scene.pbrt -q --spp 1 -o - > /dev/full; echo $?");
  EXPECT_EQ(full.out, "1\n") << full.everything();
  EXPECT_NE(full.err.find("cannot write to standard output: No space left"), std::string::npos) << full.err;
  const CommandResult closed = script("$ALHAZEN render scene.pbrt -q --spp 1 -o - >&-; echo $?");
  EXPECT_EQ(closed.out, "1\n") << closed.everything();
}

}  // namespace

}  // namespace alhazen::impl::test
