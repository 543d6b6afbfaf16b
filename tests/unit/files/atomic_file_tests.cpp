// Files that appear completely or not at all, their temporaries, and the files that paths name.

#include "files/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

#include "files/file_identity.h"
#include "files/temporary_files.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {

namespace {

namespace fs = std::filesystem;

class AtomicFiles : public ::testing::Test {
 protected:
  std::string text_of(const std::string& name) const {
    const Bytes bytes = read_file(folder_.file(name));
    return {bytes.begin(), bytes.end()};
  }
  void write(const std::string& name, const std::string& text) const {
    AtomicFile file(folder_.file(name));
    file.write(text.data(), text.size());
    file.commit();
  }
  /// Returns whether this filesystem supports nameless files.
  bool has_nameless() const {
    const int descriptor = ::open(folder_.path().c_str(), O_TMPFILE | O_WRONLY, 0600);
    if (descriptor >= 0) ::close(descriptor);
    return descriptor >= 0;
  }
  TemporaryFolder folder_;
};

TEST_F(AtomicFiles, AppearsWithCommitAlone) {
  folder_.write_text("old", "before");
  {
    AtomicFile abandoned(folder_.file("new")), replaced(folder_.file("old"));
    abandoned.write("text", 4);
    replaced.write("text", 4);
    const size_t half_files = folder_.count() - 1;
    EXPECT_EQ(half_files, has_nameless() ? 0u : 2u) << "a process that is killed now leaves nothing";
  }
  EXPECT_EQ(folder_.count(), 1u);
  EXPECT_EQ(text_of("old"), "before");
  write("old", "after");
  write("new", "first");
  EXPECT_EQ(text_of("old"), "after");
  EXPECT_EQ(text_of("new"), "first");
  EXPECT_EQ(folder_.count(), 2u) << "no temporary is left";
}

TEST_F(AtomicFiles, SeeksBackAndOn) {
  AtomicFile file(folder_.file("a"));
  file.write("0123456789", 10);
  file.seek(2);
  file.write("ab", 2);
  EXPECT_EQ(file.position(), 4u);
  file.seek(10);
  file.write("!", 1);
  file.commit();
  EXPECT_EQ(text_of("a"), "01ab456789!");
}

TEST_F(AtomicFiles, KeepsPermissionsOfWhatItReplaces) {
  folder_.write_text("a", "before");
  fs::permissions(folder_.file("a"), static_cast<fs::perms>(0640));
  write("a", "after");
  EXPECT_EQ(fs::status(folder_.file("a")).permissions(), static_cast<fs::perms>(0640));
  const mode_t mask = umask(0022);
  write("b", "new");
  umask(mask);
  EXPECT_EQ(fs::status(folder_.file("b")).permissions(), static_cast<fs::perms>(0644));
}

TEST_F(AtomicFiles, TemporariesOfKilledProcessesAreRemovedAndOthersAreNot) {
  // The name that a process without nameless files would have left behind.
  const std::string abandoned = temporary_path(folder_.path()), in_use = temporary_path(folder_.path());
  const std::string foreign = folder_.write_text(".alhazen-notes", "of the user");
  for (const std::string& path : {abandoned, in_use}) folder_.write_text(fs::path(path).filename().string(), "half");
  const int descriptor = ::open(in_use.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
  write("a", "text");
  EXPECT_FALSE(fs::exists(abandoned));
  EXPECT_TRUE(fs::exists(in_use));
  EXPECT_TRUE(fs::exists(foreign));
  ::close(descriptor);
}

TEST_F(AtomicFiles, FailuresSayWhatToDo) {
  fs::create_directory(folder_.file("folder"));
  fs::create_symlink("loop", folder_.file("loop"));
  folder_.write_text("file", "");
  for (const auto& [name, words] :
       std::vector<std::pair<std::string, std::string>>{{"folder", "give the name of a file"},
                                                        {"no/such/file", "create it first"},
                                                        {"file/below", "a part of the path is a file"},
                                                        {"loop", "circle"},
                                                        {std::string(256, 'a'), "shorter name"}}) {
    try {
      AtomicFile file(folder_.file(name));
      ADD_FAILURE() << name;
    } catch (const WriteError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
    EXPECT_THROW(check_target(folder_.file(name)), InputError) << name;
  }
  EXPECT_NO_THROW(check_target(folder_.file("file")));
  EXPECT_NO_THROW(check_target(folder_.file("new")));
  EXPECT_FALSE(fs::exists(folder_.file("new"))) << "a look leaves nothing";
}

TEST_F(AtomicFiles, ADiskThatIsFullIsToldByCommitToo) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  AtomicFile file("/dev/full");
  EXPECT_THROW(file.write("text", 4), WriteError);
  EXPECT_THROW(file.commit(), WriteError);
  EXPECT_NO_THROW(check_target("/dev/full")) << "space may be freed until the image is written";
}

TEST_F(AtomicFiles, LinksLeadToTheirTargets) {
  fs::create_directories(folder_.file("sub/deeper"));
  folder_.write_text("file", "text");
  fs::create_symlink("file", folder_.file("one"));
  fs::create_symlink("../one", folder_.file("sub/two"));
  fs::create_symlink("missing", folder_.file("sub/deeper/three"));
  fs::create_directory_symlink("sub/deeper", folder_.file("there"));
  int error = 0;
  EXPECT_TRUE(fs::equivalent(follow_links(folder_.file("sub/two"), error), folder_.file("file")));
  EXPECT_EQ(error, 0);
  EXPECT_EQ(follow_links(folder_.file("sub/deeper/three"), error), folder_.file("sub/deeper/missing"));
  EXPECT_EQ(error, 0);
  fs::create_hard_link(folder_.file("file"), folder_.file("hard"));
  for (const char* same : {"file", "one", "sub/two", "hard", "./file", "there/../../file"})
    EXPECT_TRUE(is_same_file(folder_.file("file"), folder_.file(same))) << same;
  EXPECT_TRUE(is_same_file(folder_.file("there/missing"), folder_.file("sub/deeper/three")));
  EXPECT_FALSE(is_same_file(folder_.file("file"), folder_.file("other")));
  EXPECT_FALSE(is_same_file(folder_.file("missing"), folder_.file("sub/missing")));
  EXPECT_FALSE(is_same_file("/dev/null", "/dev/null"));
}

}  // namespace

}  // namespace alhazen::impl::test
