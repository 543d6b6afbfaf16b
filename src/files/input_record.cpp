#include "files/input_record.h"

#include <sys/stat.h>

#include "util/diagnostics.h"

namespace alhazen::impl {

void InputRecord::add(const FileNumber& file, const std::string& name) {
  const std::lock_guard lock(mutex_);
  names_.try_emplace(file, name);
}

void InputRecord::refuse(const std::string& path, const std::string& role) const {
  struct stat file = {};
  if (path.empty() || ::stat(path.c_str(), &file) != 0) return;
  const std::lock_guard lock(mutex_);
  const auto found = names_.find({static_cast<uint64_t>(file.st_dev), static_cast<uint64_t>(file.st_ino)});
  if (found == names_.end()) return;
  throw InputError({path}, role + " is the same file as " + (found->second == path ? "one" : found->second + ",") +
                               " that the scene is read from: give it another name");
}

}  // namespace alhazen::impl
