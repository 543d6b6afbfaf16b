// A module that matches the program is loaded. For any other, one message says what is wrong.

#include "util/module.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "modules/probe.h"
#include "render/sample_kernel.h"
#include "support/temporary_folder.h"
#include "util/module_file.h"

namespace alhazen::impl::test {
namespace {

namespace fs = std::filesystem;

const std::string built = ALHAZEN_PROBE_FOLDER "/libalhazen_probe.so";

std::string bytes_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class Modules : public ::testing::Test {
 protected:
  /// Opens a module of those bytes.
  Module open(const std::string& bytes, const std::string& name = "probe") const {
    std::ofstream(folder_.file("libalhazen_" + name + ".so"), std::ios::binary) << bytes;
    return open_module(folder_.path(), name, "build the target");
  }

  static void expect_problem(const Module& module, const std::vector<std::string>& parts) {
    EXPECT_EQ(module.functions, nullptr);
    for (const std::string& part : parts) EXPECT_NE(module.problem.find(part), std::string::npos) << module.problem;
  }

  TemporaryFolder folder_;
};

TEST_F(Modules, OneThatFitsSharesTheLibrary) {
  const Module module = open_module(ALHAZEN_PROBE_FOLDER, "probe", "");
  ASSERT_NE(module.functions, nullptr) << module.problem;
  EXPECT_EQ(module.path, built);
  const ProbeModule& probe = functions_of<ProbeModule>(module);
  EXPECT_EQ(probe.answer, 42);
  EXPECT_EQ(probe.library_state(), &instruction_sets());
}

TEST_F(Modules, AMissingOneNamesItsFileAndHowToGetIt) {
  expect_problem(open_module(folder_.path(), "probe", "build the target"),
                 {"libalhazen_probe.so is not in " + folder_.path(), "build the target", "ALHAZEN_MODULES"});
}

TEST_F(Modules, ADamagedOneIsNotLoaded) {
  const std::string whole = bytes_of(built);
  ASSERT_GT(whole.size(), 4096u);
  for (const size_t size :
       {size_t{0}, size_t{3}, size_t{63}, size_t{64}, size_t{4096}, whole.size() / 2, whole.size() - 1})
    expect_problem(open(whole.substr(0, size)), {"damaged", folder_.path()});
  expect_problem(open(std::string(8192, 'x')), {"damaged"});
  expect_problem(open(bytes_of("/proc/self/exe")), {"damaged, or no module of Alhazen"});
}

TEST_F(Modules, OneOfOtherSourcesIsRefused) {
  const std::optional<ModuleIdentity> identity = read_module_identity(built);
  ASSERT_TRUE(identity.has_value());
  std::string interface = bytes_of(built), version = interface;
  const size_t place = interface.find(std::string(identity->magic, sizeof(identity->magic)) + identity->name);
  ASSERT_NE(place, std::string::npos);
  interface[place + offsetof(ModuleIdentity, interface)] ^= 1;
  expect_problem(open(interface),
                 {"built from other sources", std::string("the program has version ") + identity->version,
                  std::string("interface ") + identity->interface});
  version[place + offsetof(ModuleIdentity, version)] = '7';
  expect_problem(open(version), {"built from other sources", "(version 7"});
}

TEST_F(Modules, OneOfAnotherNameIsRefused) {
  expect_problem(open(bytes_of(built), "other"), {"is the module 'probe' under another name"});
}

TEST_F(Modules, AMissingLibraryIsNamed) {
  const std::string needed = "libalhazen.so", absent = "libmissing.so";
  std::string bytes = bytes_of(built);
  const size_t place = bytes.find(needed);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, needed.size(), absent);
  expect_problem(open(bytes), {"needs the library libmissing.so", "install it"});
}

}  // namespace
}  // namespace alhazen::impl::test
