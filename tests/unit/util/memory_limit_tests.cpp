// Limits of control groups are found where systems and containers put them.

#include "util/memory_limit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "support/temporary_folder.h"

namespace alhazen::impl::test {

namespace {

class MemoryLimits : public ::testing::Test {
 protected:
  /// `root` is the group that is mounted on the folder `mount`.
  std::string version_2(const std::string& root, const std::string& mount = "v2") const {
    return "30 22 0:27 " + root + " " + folder_.file(mount) + " rw,relatime shared:4 - cgroup2 cgroup2 rw\n";
  }
  std::string version_1(const std::string& root) const {
    return "34 30 0:31 " + root + " " + folder_.file("v1") + " rw,relatime - cgroup cgroup rw,memory\n" +
           "35 30 0:32 / " + folder_.file("cpu") + " rw - cgroup cgroup rw,cpu\n";
  }
  void limit(const std::string& folder, const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(folder_.file(folder));
    folder_.write_text(folder + "/" + file, text);
  }
  uint64_t found(const std::string& groups, const std::string& mounts) const {
    folder_.write_text("cgroup", groups);
    folder_.write_text("mountinfo", mounts);
    return control_group_memory(folder_.path());
  }
  static constexpr uint64_t none = std::numeric_limits<uint64_t>::max();
  TemporaryFolder folder_;
};

TEST_F(MemoryLimits, OfTheGroupOrOfOneAboutIt) {
  limit("v2/a/b", "memory.max", "5000\n");
  EXPECT_EQ(found("0::/a/b\n", version_2("/")), 5000u);
  EXPECT_EQ(found("0::/a/b/without/a/file\n", version_2("/")), 5000u);
  EXPECT_EQ(found("0::/a\n", version_2("/")), none);
  EXPECT_EQ(found("0::/\n", version_2("/")), none);
  limit("v2/a", "memory.max", "4000\n");
  EXPECT_EQ(found("0::/a/b\n", version_2("/")), 4000u);
  limit("v2/a", "memory.max", "max\n");
  EXPECT_EQ(found("0::/a/b\n", version_2("/")), 5000u);
  limit("v1/a/b", "memory.limit_in_bytes", "3000\n");
  EXPECT_EQ(found("5:cpu:/\n4:memory:/a/b\n0::/a/b\n", version_1("/") + version_2("/")), 3000u);
  EXPECT_EQ(found("4:cpuset,memory:/a/b\n", version_1("/")), 3000u);
  EXPECT_EQ(found("4:cpu:/a/b\n", version_1("/")), none);
}

TEST_F(MemoryLimits, OfContainers) {
  // The container's group is mounted, and named as outside or as the root; a namespace names others relative to its
  // root.
  limit("v2", "memory.max", "6000\n");
  for (const char* group : {"/docker/1", "/", "/../2", "/docker/10"})
    EXPECT_EQ(found(std::string("0::") + group + "\n", version_2("/docker/1")), 6000u) << group;
  limit("v2/inner", "memory.max", "5500\n");
  EXPECT_EQ(found("0::/docker/1/inner\n", version_2("/docker/1")), 5500u);
  limit("with blank", "memory.max", "7000\n");
  EXPECT_EQ(found("0::/\n", version_2("/", "with\\040blank")), 7000u);
}

TEST_F(MemoryLimits, WhatCannotBeReadIsNoLimit) {
  EXPECT_EQ(control_group_memory(folder_.file("nothing")), none);
  for (const char* text : {"", "\n", "0\n", "-5\n", "many\n", "12x\n", "99999999999999999999999\n"}) {
    limit("v2", "memory.max", text);
    EXPECT_EQ(found("0::/\n", version_2("/")), none) << text;
  }
  limit("v2", "memory.max", "6000\n");
  for (const char* groups : {"", "\n", ":", "0:", "0::\n", "0:x:/\n"})
    EXPECT_EQ(found(groups, version_2("/")), none) << groups;
  for (const char* mounts : {"", "\n", "30 22 0:27 / /x rw", "30 22 0:27 / /x rw - cgroup2\n", "- - - - - - -\n"})
    EXPECT_EQ(found("0::/\n", mounts), none) << mounts;
  EXPECT_EQ(found("0::relative\n", version_2("/")), 6000u);
  EXPECT_GT(physical_memory(), uint64_t{1} << 20);
}

}  // namespace

}  // namespace alhazen::impl::test
