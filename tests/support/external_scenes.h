#pragma once

// Scenes that are not part of the repository because of their licences or size.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace alhazen::impl::test {

/// Returns the folder in ALHAZEN_SCENES, else `shared/scenes` in the repository or beside it; empty if there is none.
inline std::filesystem::path external_scenes() {
  std::vector<std::filesystem::path> candidates;
  if (const char* folder = std::getenv("ALHAZEN_SCENES")) candidates.emplace_back(folder);
  const std::filesystem::path source = ALHAZEN_SOURCE_DIR;
  candidates.push_back(source / "shared" / "scenes");
  candidates.push_back(source.parent_path() / "shared" / "scenes");
  for (const std::filesystem::path& folder : candidates)
    if (std::filesystem::is_directory(folder)) return folder;
  return {};
}

/// Returns the files below the subfolder `folder` of external_scenes() that have one of these extensions, sorted.
inline std::vector<std::filesystem::path> external_files(const std::string& folder,
                                                         const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = external_scenes();
  if (root.empty() || !std::filesystem::is_directory(root / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
    if (entry.is_regular_file() &&
        std::find(extensions.begin(), extensions.end(), entry.path().extension()) != extensions.end())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace alhazen::impl::test
