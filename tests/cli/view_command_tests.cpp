// `alhazen view` at the command line. What it serves is tested in tests/view and tests/browser.

#include <csignal>
#include <regex>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class ViewCommand : public Command {
 protected:
  /// Runs it until `text` is on stderr, then presses Ctrl-C.
  CommandResult view_until(const std::string& text, std::vector<std::string> arguments) const {
    CommandOptions options;
    options.folder = folder_.path();
    options.timeout = 60;
    options.signal_when = [text](const std::string& err) { return err.find(text) == std::string::npos ? 0 : SIGINT; };
    arguments.insert(arguments.begin(), "view");
    return run_alhazen(arguments, options);
  }
};

TEST_F(ViewCommand, PrintsTheAddressAloneAndEndsByCtrlC) {
  const CommandResult result = view_until("ssh -L", {"scene.pbrt", "--size", "16x16", "--spp", "4"});
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_TRUE(std::regex_match(result.out, std::regex(R"(http://127\.0\.0\.1:\d+/[0-9A-Za-z_-]{20,}/\n)")))
      << result.out;
  std::smatch port;
  ASSERT_TRUE(std::regex_search(result.out, port, std::regex(R"(:(\d+)/)")));
  EXPECT_NE(result.err.find("ssh -L " + port[1].str() + ":127.0.0.1:" + port[1].str()), std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("warning"), std::string::npos) << result.err;
  EXPECT_EQ(folder_.count(), 1u) << "it writes nothing";
}

TEST_F(ViewCommand, WarnsWhereOthersCanReachIt) {
  const CommandResult result =
      view_until("warning: everyone", {"scene.pbrt", "--size", "16x16", "--spp", "4", "--listen", "0.0.0.0"});
  EXPECT_EQ(result.exit_code, 130) << result.everything();
}

TEST_F(ViewCommand, StaysWithASceneThatFails) {
  folder_.write_text("broken.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" [\n");
  const CommandResult result = view_until("broken.pbrt:", {"broken.pbrt"});
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_NE(result.out.find("http://"), std::string::npos);
}

TEST_F(ViewCommand, RefusesBadInput) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"view", "missing.pbrt"}, "missing.pbrt"},
      {{"view", "scene.pbrt", "--port", "70000"}, "--port"},
      {{"view", "scene.pbrt", "--port", "-1"}, "--port"},
      {{"view", "scene.pbrt", "--viewers", "0"}, "--viewers"},
      {{"view", "scene.pbrt", "--listen", "here"}, "here"},
      {{"view", "scene.pbrt", "--size", "16"}, "--size"},
      {{"view", "scene.pbrt", "--output", "a.png"}, "--output"},
      {{"view"}, "SCENE"},
  };
  for (const auto& [arguments, expected] : cases) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.everything();
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace

}  // namespace alhazen::impl::test
