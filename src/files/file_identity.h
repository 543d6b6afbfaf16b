#pragma once

// Which file a path names: through symbolic links, by any spelling, whether the file exists or not.

#include <string>
#include <vector>

namespace alhazen {

/// Where a write to `path` ends up: symbolic links are followed, relative ones from the folder that they are in, also
/// to a file that does not exist yet. `error` is 0, or the errno that says why there is no such place.
std::string follow_links(const std::string& path, int& error);

/// The folder part of a path, "." where it has none.
std::string folder_of_path(const std::string& path);

/// Whether both paths name one file: by other spellings, by symbolic links or by hard links. Of files that do not exist
/// yet, whether both would make the same one. Devices such as /dev/null hold nothing that a second use could destroy,
/// and count as different files.
bool is_same_file(const std::string& a, const std::string& b);

/// A file and what the user knows it as: "the scene", "the output".
struct NamedFile {
  std::string path;
  std::string role;
};

/// Throws InputError where `written` is the same file as one of `others`. Those with an empty path are left out.
void refuse_same_file(const NamedFile& written, const std::vector<NamedFile>& others);

}  // namespace alhazen
