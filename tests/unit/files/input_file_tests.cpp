// Opening of input: regular files only, and none outside a confining folder.

#include "files/input_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "support/temporary_folder.h"
#include "util/diagnostics.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

std::string text_of(const InputPath& path) {
  const std::vector<uint8_t> bytes = InputFile(path).read_all();
  return {bytes.begin(), bytes.end()};
}

std::string error_of(const InputPath& path) {
  try {
    return "read: " + text_of(path);
  } catch (const InputError& error) {
    return error.what();
  }
}

void make_socket(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof(address.sun_path));
  path.copy(address.sun_path, path.size());
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  close(descriptor);
}

TEST(InputFile, ReadsWhatThereIs) {
  TemporaryFolder folder;
  const std::string path = folder.write_text("a", "some bytes");
  EXPECT_EQ(text_of(path), "some bytes");
  EXPECT_EQ(InputFile(path).size(), 10u);
  fs::create_symlink("a", folder.file("link"));
  EXPECT_EQ(text_of(folder.file("link")), "some bytes");
  EXPECT_EQ(InputFile(path).identity(), InputFile(folder.file("link")).identity());
  EXPECT_EQ(text_of(folder.write_text("empty", "")), "");
}

TEST(InputFile, RefusesWhatIsNoRegularFile) {
  TemporaryFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder.file("link"));
  fs::create_symlink("/dev/zero", folder.file("zero"));
  fs::create_symlink("loop", folder.file("loop"));
  const std::string socket_path = "/tmp/alhazen-" + std::to_string(getpid()) + ".socket";
  make_socket(socket_path);
  const std::pair<std::string, std::string> cases[] = {
      {folder.file("pipe"), "is a pipe"},    {folder.file("link"), "is a pipe"},
      {"/dev/zero", "is a device"},          {"/dev/null", "is a device"},
      {folder.file("zero"), "is a device"},  {folder.path(), "is a folder"},
      {folder.file("none"), "No such file"}, {folder.file("loop"), "symbolic links"},
      {socket_path, "is a socket"},          {"", "no file is named"},
      {std::string("a\0b", 3), "zero byte"}};
  for (const auto& [path, message] : cases)
    EXPECT_NE(error_of(path).find(message), std::string::npos) << error_of(path);
  fs::remove(socket_path);
  EXPECT_TRUE(input_problem(folder.file("none")).is_missing);
  EXPECT_FALSE(input_problem("/dev/zero").is_missing);
  EXPECT_EQ(input_problem(folder.write_text("a", "")).message, "");
}

/// With openat2, and as on kernels without it.
class Confined : public ::testing::TestWithParam<bool> {
 protected:
  Confined() {
    fs::create_directories(folder_.file("scene/sub"));
    folder_.write_text("secret", "secret");
    folder_.write_text("scene/inside", "inside");
    fs::create_symlink("../inside", folder_.file("scene/sub/link-inside"));
    fs::create_symlink("../secret", folder_.file("scene/link-out"));
    fs::create_symlink("..", folder_.file("scene/folder-out"));
    fs::create_symlink(folder_.file("secret"), folder_.file("scene/absolute-out"));
    fs::create_symlink("/proc/self/root" + folder_.file("secret"), folder_.file("scene/magic-out"));
    fs::create_symlink("link-out", folder_.file("scene/link-to-link-out"));
    // A name that begins with the folder's name.
    fs::create_directories(folder_.file("scene-two"));
    folder_.write_text("scene-two/secret", "secret");
  }

  InputPath path(const std::string& name, const std::string& folder) const {
    return {name, {std::make_shared<const Confinement>(folder, GetParam()), nullptr}};
  }
  InputPath path(const std::string& name) const { return path(folder_.file("scene/" + name), folder_.file("scene")); }

  TemporaryFolder folder_;
};

TEST_P(Confined, ReadsWithinTheFolder) {
  for (const char* name : {"inside", "./inside", "sub/../inside", "sub/link-inside", "sub//../inside"})
    EXPECT_EQ(text_of(path(name)), "inside") << name;
  // A path that does not begin with the folder's name, as on the command line.
  EXPECT_EQ(text_of(path(folder_.file("scene/inside"), folder_.file("scene-two/../scene"))), "inside");
  EXPECT_EQ(text_of(path(folder_.file("scene") + "//inside", folder_.file("scene") + "/")), "inside");
}

TEST_P(Confined, RefusesEveryPathThatLeadsOutside) {
  for (const char* name :
       {"../secret", "sub/../../secret", "link-out", "link-to-link-out", "folder-out/secret", "absolute-out",
        "magic-out", "sub/../folder-out/scene/sub/../../secret", "../scene-two/secret", "../nothing-of-that-name"}) {
    const std::string error = error_of(path(name));
    EXPECT_NE(error.find("outside the scene's folder"), std::string::npos) << name << ": " << error;
    EXPECT_EQ(error.find("read:"), std::string::npos) << name;
  }
  for (const std::string& outside : {folder_.file("secret"), folder_.file("scene-two/secret"),
                                     std::string("/etc/passwd"), folder_.file("scene/../secret")})
    EXPECT_NE(error_of(path(outside, folder_.file("scene"))).find("outside the scene's folder"), std::string::npos)
        << outside;
}

TEST_P(Confined, TellsWhatElseIsWrong) {
  EXPECT_TRUE(input_problem(path("none")).is_missing);
  EXPECT_NE(error_of(path("sub")).find("is a folder"), std::string::npos);
  EXPECT_THROW(Confinement(folder_.file("no-folder")), InputError);
}

/// The folder is the one that was opened, not whatever has its name later.
TEST_P(Confined, HoldsTheFolder) {
  const InputPath inside = path("inside");
  fs::rename(folder_.file("scene"), folder_.file("moved"));
  fs::create_directories(folder_.file("scene"));
  folder_.write_text("scene/inside", "another");
  EXPECT_EQ(text_of(inside), "inside");
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutOpenat2, Confined, ::testing::Bool());

}  // namespace

}  // namespace alhazen::impl::test
