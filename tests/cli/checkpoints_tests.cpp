// Checkpoints and existing files in their place: nothing is lost, and a failed save does not end a render.

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class Checkpoints : public Command {
 protected:
  /// Renders 16 samples per pixel, quietly, into `name`.
  CommandResult small(const std::string& name, std::vector<std::string> arguments, CommandOptions options = {}) const {
    arguments.insert(arguments.end(), {"-o", name, "--exr-type", "float", "-q"});
    if (std::find(arguments.begin(), arguments.end(), "--spp") == arguments.end())
      arguments.insert(arguments.end(), {"--spp", "16"});
    return render(arguments, options);
  }
  void expect_refused(const CommandResult& result, const std::vector<std::string>& words) const {
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word << result.err;
    EXPECT_FALSE(exists("refused.exr"));
  }
};

TEST_F(Checkpoints, NoFileIsReplacedUnasked) {
  for (const std::string text :
       {"notes", "a text that is longer than the header of a checkpoint, which has 64 bytes"}) {
    folder_.write_text("notes", text);
    expect_refused(small("refused.exr", {"--checkpoint", "notes"}), {"notes: ", "not a checkpoint", "--overwrite"});
    EXPECT_EQ(read_file(folder_.file("notes")).size(), text.size());
  }
  ASSERT_EQ(small("a.exr", {"--checkpoint", "state"}).exit_code, 0);
  const Bytes longer = read_file(folder_.file("state"));
  for (const char* samples : {"8", "16", "64"}) {
    expect_refused(small("refused.exr", {"--checkpoint", "state", "--spp", samples}),
                   {"state: ", "16 samples", "--resume", "--overwrite"});
    EXPECT_EQ(read_file(folder_.file("state")), longer);
  }
  EXPECT_EQ(small("b.exr", {"--checkpoint", "state", "--spp", "8", "--overwrite"}).exit_code, 0);
  EXPECT_NE(read_file(folder_.file("state")), longer);
  EXPECT_EQ(small("b.exr", {"--checkpoint", "notes", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(small("b.exr", {"--checkpoint", "notes", "--resume", "--spp", "20"}).exit_code, 0);
  folder_.write_text("empty", "");
  EXPECT_EQ(small("b.exr", {"--checkpoint", "empty"}).exit_code, 0) << "as mktemp makes it: there is nothing to lose";
}

TEST_F(Checkpoints, OnlyFilesCanBeReadAgain) {
  for (const char* name : {"/dev/null", "/dev/full"})
    if (std::filesystem::exists(name)) expect_refused(small("refused.exr", {"--checkpoint", name}), {"device"});
  ASSERT_EQ(run_command({"/usr/bin/mkfifo", folder_.file("pipe")}).exit_code, 0);
  expect_refused(small("refused.exr", {"--checkpoint", "pipe"}), {"pipe: "});
  expect_refused(small("refused.exr", {"--checkpoint", "pipe", "--resume"}), {"pipe: "});
}

TEST_F(Checkpoints, ALinkIsFollowed) {
  std::filesystem::create_symlink("target", folder_.file("state"));
  EXPECT_EQ(small("a.exr", {"--checkpoint", "state", "--spp", "8"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.file("state")));
  EXPECT_TRUE(exists("target"));
  EXPECT_EQ(small("a.exr", {"--checkpoint", "state", "--resume"}).exit_code, 0);
  ASSERT_EQ(small("b.exr", {}).exit_code, 0);
  EXPECT_EQ(image("a.exr").planes, image("b.exr").planes);
}

/// The limit admits the image but not the state, which is eight times as large.
TEST_F(Checkpoints, ASaveThatFailsIsAWarning) {
  CommandOptions options;
  options.file_size = 24 * 1024;
  ASSERT_EQ(render({"-o", "a.exr", "--size", "48x48", "--spp", "16", "-q"}).exit_code, 0);
  const size_t files = folder_.count();
  const CommandResult result =
      render({"-o", "b.exr", "--size", "48x48", "--spp", "16", "--checkpoint", "state,0"}, options);
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  const std::string warning = "warning: state: the checkpoint was not saved, and the render continues: ";
  const size_t first = result.err.find(warning);
  EXPECT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(warning, first + 1), std::string::npos) << "told once\n" << result.err;
  EXPECT_EQ(image("a.exr").planes, image("b.exr").planes);
  EXPECT_EQ(folder_.count(), files + 1);
}

TEST_F(Checkpoints, AnyDamageIsRefused) {
  ASSERT_EQ(small("a.exr", {"--checkpoint", "state"}).exit_code, 0);
  const Bytes whole = read_file(folder_.file("state"));
  const auto refuse = [&](const Bytes& bytes) {
    folder_.write("state", bytes);
    expect_refused(small("refused.exr", {"--checkpoint", "state", "--resume", "--spp", "32"}), {"state: "});
    EXPECT_EQ(read_file(folder_.file("state")), bytes);
  };
  for (const size_t at : {size_t{0}, size_t{7}, size_t{20}, size_t{40}, whole.size() / 2, whole.size() - 1}) {
    Bytes flipped = whole;
    flipped[at] ^= 0x80;
    refuse(flipped);
  }
  refuse({whole.begin(), whole.end() - 4});
  refuse({whole.begin(), whole.begin() + 64});
  refuse({});
  Bytes extended = whole;
  extended.resize(whole.size() + 4);
  refuse(extended);
}

}  // namespace

}  // namespace alhazen::impl::test
