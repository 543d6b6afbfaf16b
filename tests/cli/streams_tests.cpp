// Standard streams that are full, closed, or without a reader: only their own output is lost.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Streams : public Command {
 protected:
  /// Runs a script in the folder; $RENDER renders the scene.
  CommandResult script(const std::string& text) const {
    CommandOptions options;
    options.folder = folder_.path();
    return run_script("RENDER=\"$ALHAZEN render scene.pbrt --size 16x16 -t 1 --exr-type float\"\n" + text, options);
  }

  /// The bits of the image of every render in these tests.
  Image expected() const {
    EXPECT_EQ(script("$RENDER --spp 8 -q -o expected.exr").exit_code, 0);
    return image("expected.exr");
  }
};

TEST_F(Streams, StderrThatTakesNothingKeepsTheImage) {
  const Image whole = expected();
  const bool has_full = std::filesystem::exists("/dev/full");
  for (const std::string options : {"", "--progress json", "--progress plain -v", "-q"})
    for (const std::string stream : {"2>&-", "2>/dev/full", "2>&- >&- <&-", ">&- 2>/dev/full", "<&- 2>&-"}) {
      if (!has_full && stream.find("full") != std::string::npos) continue;
      SCOPED_TRACE(options + " " + stream);
      const CommandResult result = script("$RENDER --spp 8 -o a.exr -o a.png " + options + " " + stream);
      EXPECT_EQ(result.exit_code, 0) << result.everything();
      ASSERT_TRUE(exists("a.exr"));
      EXPECT_EQ(image("a.exr").planes, whole.planes) << "no message is written into the image";
      EXPECT_EQ(image("a.png").width, 16);
      std::filesystem::remove(folder_.file("a.exr"));
    }
}

TEST_F(Streams, ReaderOfStderrThatLeavesKeepsTheImage) {
  const Image whole = expected();
  const CommandResult result =
      script("{ sleep 0.3; $RENDER --spp 8 --progress json -v -o a.exr; echo $? > code; } 2>&1 | true; cat code");
  EXPECT_EQ(result.out, "0\n") << result.everything();
  EXPECT_EQ(image("a.exr").planes, whole.planes);
}

/// The read end of the pipe stays open, but nobody reads from it.
TEST_F(Streams, ReaderOfStderrThatStopsKeepsTheImage) {
  const CommandResult result = script(
      "mkfifo pipe && exec 3<>pipe && head -c 65536 /dev/zero >&3\n"
      "timeout -k 1 60 $RENDER --spp 10000000 --time-limit 0.6 --progress json -v -o a.exr 2>&3; echo $?");
  EXPECT_EQ(result.out, "0\n") << result.everything();
  EXPECT_LT(result.seconds, 45);
  EXPECT_TRUE(exists("a.exr"));
}

TEST_F(Streams, ErrorsKeepTheirExitCodes) {
  for (const std::string stream : {"2>&-", "2>/dev/full"}) {
    if (!std::filesystem::exists("/dev/full")) break;
    EXPECT_EQ(script("$ALHAZEN render missing.pbrt " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN paint " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN info missing.pbrt " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN compare a.exr b.exr " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN study compare a.json b.json " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN study tune missing.pbrt " + stream).exit_code, 2);
    EXPECT_EQ(script("$ALHAZEN study report --scene missing.pbrt -o out " + stream).exit_code, 2);
    EXPECT_EQ(
        script("ln -s /dev/full f.png; $RENDER --spp 1 -o f.png " + stream + "; rc=$?; rm f.png; exit $rc").exit_code,
        1);
  }
}

/// If stdout is the requested output, failing to write it is an error; the image is kept all the same.
TEST_F(Streams, ReportsThatCannotBeWrittenAreFailures) {
  ASSERT_EQ(script("$RENDER --spp 1 -q -o a.exr").exit_code, 0);
  for (const std::string stream : {">&-", ">/dev/full"}) {
    if (stream != ">&-" && !std::filesystem::exists("/dev/full")) continue;
    for (const std::string command : {"devices", "devices --json", "info scene.pbrt", "info scene.pbrt --json",
                                      "info scene.pbrt --list", "render scene.pbrt --list", "compare a.exr a.exr",
                                      "compare a.exr a.exr --json", "--help", "--version", "render --help"}) {
      const CommandResult result = script("$ALHAZEN " + command + " " + stream);
      EXPECT_EQ(result.exit_code, 1) << command << " " << stream << "\n" << result.everything();
      EXPECT_NE(result.err.find("cannot write to the standard output: "), std::string::npos) << result.err;
    }
    for (const std::string statistics : {"--stats", "--stats=json"}) {
      const CommandResult result = script("rm -f b.exr; $RENDER --spp 1 -o b.exr " + statistics + " " + stream);
      EXPECT_EQ(result.exit_code, 1) << result.everything();
      EXPECT_TRUE(exists("b.exr"));
    }
    EXPECT_EQ(script("$RENDER --spp 1 -o b.exr " + stream).exit_code, 0) << "nothing was to be printed";
  }
}

TEST_F(Streams, ReaderOfStdoutThatLeavesIsAFailureAndNoSignal) {
  const CommandResult result = script("{ sleep 0.3; $ALHAZEN info scene.pbrt; echo $? > code; } | true; cat code");
  EXPECT_EQ(result.out, "1\n") << result.everything();
}

}  // namespace

}  // namespace alhazen::impl::test
