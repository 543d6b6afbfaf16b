#include "io/find_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "util/diagnostics.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

/// The paths below a folder at which a file of that name is looked for.
std::vector<std::string> candidates(const std::string& name) {
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  const fs::path path(with_slashes), last = path.filename();
  if (last.empty() || last == "." || last == "..") return {};
  std::vector<std::string> paths;
  const bool leads_downwards =
      path.is_relative() && std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
  if (leads_downwards && path != last) paths.push_back(path.string());
  paths.push_back(last.string());
  return paths;
}

}  // namespace

FoundFile find_file(const std::string& folder, const std::string& name, const InputScope& scope,
                    const FileSearch& search) {
  FoundFile found{{(fs::path(folder) / name).string(), scope}, {}};
  found.problem = input_problem(found.path);
  if (!found.problem.is_missing || name.empty() || name.find('\0') != std::string::npos) return found;
  for (const std::string& other : search.folders)
    for (const std::string& candidate : candidates(name)) {
      InputPath path((fs::path(other) / candidate).string(), scope);
      if (input_problem(path).message.empty()) return {std::move(path), {}};
    }
  return found;
}

void check_search_folders(const FileSearch& search, const InputScope& scope) {
  for (const std::string& folder : search.folders) {
    constexpr int flags = O_PATH | O_DIRECTORY | O_CLOEXEC;
    const int descriptor = scope.confinement ? scope.confinement->open(folder, flags) : ::open(folder.c_str(), flags);
    const int problem = errno;
    if (descriptor >= 0) {
      ::close(descriptor);
      continue;
    }
    const std::string option = "--search-path " + quoted(folder);
    if (problem == EXDEV)
      throw InputError(option +
                       " is outside the scene's folder, and reading is confined to that folder (--confine): "
                       "name a folder within it, or read without the confinement");
    throw InputError(option + " cannot be searched: " + std::strerror(problem) + "; name a folder that exists");
  }
}

std::string search_hint(const FileSearch& search) {
  return search.folders.empty() ? "; --search-path names more folders to look in"
                                : "; it is not in a folder of --search-path either";
}

ImageTexels missing_image(const std::string& name) { return {1, 1, {255, 0, 255}, {}, true, name}; }

}  // namespace alhazen::impl
