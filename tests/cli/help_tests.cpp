// --help and --help-all of every subcommand.

#include <set>

#include "cli/fixture.h"
#include "cli/help.h"

namespace alhazen::impl::test {

namespace {

class Help : public Command {
 protected:
  static inline const std::vector<std::vector<std::string>> subcommands{
      {},        {"render"},          {"compare"},       {"devices"},          {"info"},      {"view"},
      {"study"}, {"study", "report"}, {"study", "tune"}, {"study", "compare"}, {"completion"}};

  std::vector<std::string> lines(std::vector<std::string> subcommand, const std::string& flag) const {
    subcommand.push_back(flag);
    const CommandResult result = run(subcommand);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_EQ(result.err, "");
    return lines_of(result.out);
  }

  /// The options that have a line of their own.
  static std::set<std::string> options(const std::vector<std::string>& lines) {
    std::set<std::string> names;
    for (const std::string& line : lines)
      if (line.starts_with("  -")) names.insert(line.substr(2, line.find(' ', 2) - 2));
    return names;
  }
};

TEST_F(Help, FitsOnTwoScreens) {
  for (const auto& subcommand : subcommands) {
    const std::string name = subcommand.empty() ? "alhazen" : subcommand.back();
    const auto help = lines(subcommand, "--help"), all = lines(subcommand, "--help-all");
    EXPECT_LE(help.size(), max_help_lines) << name;
    for (const auto& text : {help, all})
      for (const std::string& line : text) EXPECT_LE(line.size(), help_columns) << name << ": " << line;
  }
}

TEST_F(Help, AllListsWhatHelpLists) {
  for (const auto& subcommand : subcommands) {
    const auto common = options(lines(subcommand, "--help")), all = options(lines(subcommand, "--help-all"));
    EXPECT_TRUE(common.contains("-h,--help"));
    for (const std::string& name : common) EXPECT_TRUE(all.contains(name)) << name;
  }
  EXPECT_EQ(options(lines({"devices"}, "--help")), options(lines({"devices"}, "--help-all")));
}

TEST_F(Help, OfRenderListsTheCommonOptionsAndSaysHowToListAll) {
  const auto help = lines({"render"}, "--help"), all = lines({"render"}, "--help-all");
  const auto common = options(help), every = options(all);
  for (const char* name : {"-o,--output,--outfile", "--spp", "--size", "--denoise", "--quality", "--camera"})
    EXPECT_TRUE(common.contains(name)) << name;
  for (const char* name : {"--guiding-memory", "--chunk", "--coats"}) {
    EXPECT_FALSE(common.contains(name)) << name;
    EXPECT_TRUE(every.contains(name)) << name;
  }
  EXPECT_NE(help.back().find("'alhazen render --help-all'"), std::string::npos) << help.back();
  EXPECT_EQ(run({"render", "-h"}).out, run({"render", "--help"}).out);
  EXPECT_NE(lines({}, "--help").back().find("'alhazen SUBCOMMAND --help'"), std::string::npos);
}

}  // namespace

}  // namespace alhazen::impl::test
