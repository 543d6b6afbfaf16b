// Signals other than the first Ctrl-C, and system limits that are reported by signals.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Signals : public Command {
 protected:
  /// A script in the folder. $RENDER renders for ever; wait_for_samples waits for its first report in err.
  CommandResult script(const std::string& text) const {
    CommandOptions options;
    options.folder = folder_.path();
    return run_script(
        "RENDER=\"$ALHAZEN render scene.pbrt --size 16x16 -t 1 --spp 10000000 --progress json\"\n"
        "rm -f err\n" +
            wait_for_samples + text,
        options);
  }
};

/// As nohup does, and scripts that protect their children. (SIGINT has a test of its own below.)
TEST_F(Signals, ThoseThatCameIgnoredStayIgnored) {
  for (const std::string name : {"HUP", "TERM", "XCPU"}) {
    const CommandResult result = script("(trap '' " + name +
                                        "; exec $RENDER --time-limit 2 -o a.exr) 2>err & p=$!\n"
                                        "wait_for_samples; kill -" +
                                        name + " $p; wait $p; echo $?");
    EXPECT_EQ(result.out, "0\n") << name << result.everything();
  }
}

/// A shell without job control starts commands after & with SIGINT ignored; a SIGINT by kill is meant for the program.
TEST_F(Signals, InterruptByKillReachesWhatRunsInTheBackground) {
  const CommandResult result =
      script("$RENDER -o a.exr 2>err & p=$!\nwait_for_samples; kill -INT $p; wait $p; echo $?");
  EXPECT_EQ(result.out, "130\n") << result.everything();
  EXPECT_TRUE(exists("a.exr"));
}

/// A pipe without a reader is abandoned a second after the first signal; the second signal arrives before that.
TEST_F(Signals, ASecondOneEndsAtOnce) {
  for (const auto& [first, second, code] :
       {std::tuple{"TERM", "TERM", 128 + SIGTERM}, {"INT", "TERM", 128 + SIGTERM}, {"HUP", "INT", 128 + SIGINT}}) {
    const CommandResult result =
        script("rm -f p.exr; mkfifo p.exr; $RENDER -o p.exr 2>err & p=$!\nwait_for_samples; kill -" +
               std::string(first) + " $p; sleep 0.4; kill -" + second + " $p; wait $p; echo $?");
    EXPECT_EQ(result.out, std::to_string(code) + "\n") << first << second << result.everything();
  }
}

/// Both the shell and the kernel send it when a terminal closes, and a session manager does after its SIGTERM.
TEST_F(Signals, HangUpAfterAnotherIsNoSecondOne) {
  for (const std::string both :
       {"kill -HUP $p; kill -HUP $p", "kill -TERM $p; kill -HUP $p", "kill -HUP $p; kill -TERM $p"}) {
    const CommandResult result =
        script("rm -f a.exr; $RENDER -o a.exr 2>err & p=$!\nwait_for_samples; " + both + "; wait $p; echo $?");
    EXPECT_EQ(result.out, "130\n") << result.everything();
    EXPECT_TRUE(exists("a.exr"));
  }
}

/// A limit on processor time sends SIGXCPU, and batch systems send it before SIGTERM: together they are one request.
/// While the process is stopped, both signals become pending, and their handlers interrupt each other.
TEST_F(Signals, ALimitOnProcessorTimeIsNoFirstOne) {
  for (const std::string both :
       {"kill -XCPU $p; sleep 0.05; kill -TERM $p", "kill -XCPU $p; kill -TERM $p", "kill -TERM $p; kill -XCPU $p",
        "kill -XCPU $p; kill -INT $p", "kill -XCPU $p; kill -XCPU $p; kill -HUP $p",
        "kill -STOP $p; kill -XCPU $p; kill -TERM $p; kill -CONT $p",
        "kill -STOP $p; kill -XCPU $p; kill -INT $p; kill -CONT $p",
        "kill -STOP $p; kill -HUP $p; kill -TERM $p; kill -XCPU $p; kill -CONT $p"}) {
    const CommandResult result = script(
        "rm -f a.exr a.ck; $RENDER -o a.exr --checkpoint a.ck 2>err & p=$!\n"
        "wait_for_samples; " +
        both + "; wait $p; echo $?");
    EXPECT_EQ(result.out, "130\n") << both << result.everything();
    EXPECT_TRUE(exists("a.exr")) << both;
    EXPECT_TRUE(exists("a.ck")) << both;
  }
  const CommandResult result = script(
      "rm -f p.exr; mkfifo p.exr; $RENDER -o p.exr 2>err & p=$!\nwait_for_samples; kill -XCPU $p; kill -TERM $p; "
      "sleep 0.4; kill -TERM $p; wait $p; echo $?");
  EXPECT_EQ(result.out, std::to_string(128 + SIGTERM) + "\n") << "a second request still ends at once";
}

TEST_F(Signals, ALimitOnTheSizeOfFilesIsASentence) {
  CommandOptions options;
  options.file_size = 1024;
  for (const char* name : {"a.exr", "a.png"}) {
    folder_.write_text(name, "an older picture");
    const size_t files = folder_.count();
    const CommandResult result = render({"-o", name, "--size", "64x64", "--spp", "1", "-q"}, options);
    EXPECT_EQ(result.exit_code, 1) << result.everything();
    EXPECT_NE(result.err.find("ulimit -f"), std::string::npos) << result.err;
    EXPECT_EQ(read_file(folder_.file(name)).size(), std::string("an older picture").size());
    EXPECT_EQ(folder_.count(), files) << "nothing else is left";
  }
}

}  // namespace

}  // namespace alhazen::impl::test
