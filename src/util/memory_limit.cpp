#include "util/memory_limit.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

namespace alhazen::impl {

namespace {

constexpr uint64_t no_limit = std::numeric_limits<uint64_t>::max();

/// A control group hierarchy that limits memory, and the location of its files.
struct Hierarchy {
  bool is_version_2 = false;
  std::string root;   ///< the group that is mounted
  std::string mount;  ///< the mount point
};

/// Returns whether `name` is in a comma-separated list.
bool lists(std::string_view list, std::string_view name) {
  while (!list.empty()) {
    const size_t end = std::min(list.find(','), list.size());
    if (list.substr(0, end) == name) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

/// Paths in mountinfo have blanks and backslashes as octal escapes.
std::string without_escapes(const std::string& text) {
  const auto is_digit = [&](size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '7'; };
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || !is_digit(i + 1) || !is_digit(i + 2) || !is_digit(i + 3)) {
      plain += text[i];
      continue;
    }
    plain += static_cast<char>((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + (text[i + 3] - '0'));
    i += 3;
  }
  return plain;
}

/// Parses lines such as `34 30 0:31 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory`, proc(5).
std::vector<Hierarchy> hierarchies(const std::string& mountinfo) {
  std::vector<Hierarchy> all;
  std::ifstream file(mountinfo);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string skipped, root, mount, type, options;
    words >> skipped >> skipped >> skipped >> root >> mount;
    while (words >> skipped && skipped != "-") {
    }
    if (!(words >> type >> skipped >> options)) continue;
    if (type == "cgroup2" || (type == "cgroup" && lists(options, "memory")))
      all.push_back({type == "cgroup2", without_escapes(root), without_escapes(mount)});
  }
  return all;
}

/// Returns the group of the process, from lines such as `4:memory:/a/b`, in version 2 `0::/a/b`; empty if there is
/// none.
std::string group_in(const std::string& groups, bool version_2) {
  std::ifstream file(groups);
  for (std::string line; std::getline(file, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string_view controllers = std::string_view(line).substr(first + 1, second - first - 1);
    if (version_2 ? line.starts_with("0::") : lists(controllers, "memory")) return line.substr(second + 1);
  }
  return {};
}

/// Reads a file of one number; version 2 writes `max` for no limit.
uint64_t limit_in(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  uint64_t limit = 0;
  if (!(file >> text)) return no_limit;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit);
  return error == std::errc() && end == text.data() + text.size() && limit > 0 ? limit : no_limit;
}

/// Returns the path from the mounted group down to `group`. A group that appears to be elsewhere, as it may from within
/// a container, is taken for the mounted one.
std::string path_to(const std::string& group, const std::string& root) {
  const std::string above = root == "/" ? "" : root;
  const bool is_below = group.starts_with(above) && (group.size() == above.size() || group[above.size()] == '/');
  if (!is_below || group.find("/..") != std::string::npos) return {};
  return group == "/" ? "" : group.substr(above.size());
}

}  // namespace

uint64_t control_group_memory(const std::string& process) {
  uint64_t smallest = no_limit;
  for (const Hierarchy& h : hierarchies(process + "/mountinfo")) {
    const std::string group = group_in(process + "/cgroup", h.is_version_2);
    if (group.empty()) continue;
    const char* const name = h.is_version_2 ? "/memory.max" : "/memory.limit_in_bytes";
    for (std::string path = path_to(group, h.root);; path.resize(path.rfind('/'))) {
      smallest = std::min(smallest, limit_in(h.mount + path + name));
      if (path.empty()) break;
    }
  }
  return smallest;
}

uint64_t physical_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  const uint64_t machine =
      pages > 0 && page > 0 ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page) : no_limit;
  return std::min(machine, control_group_memory("/proc/self"));
}

}  // namespace alhazen::impl
