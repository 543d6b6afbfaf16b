#pragma once

// Identifies the file that a path names: through symbolic links, in any spelling, whether or not the file exists.

#include <string>
#include <vector>

namespace alhazen::impl {

/// The path to which a write to `path` leads: symbolic links are followed, relative ones from their own folder, also to
/// a file that does not exist yet. `error` is 0, or the errno that says why there is no such path.
std::string follow_links(const std::string& path, int& error);

/// The folder part of a path, "." if it has none.
std::string folder_of_path(const std::string& path);

/// Returns whether both paths name the same file: by other spellings, symbolic links or hard links. For files that do
/// not exist yet, whether both would create the same one. Devices such as /dev/null count as different files, since a
/// second use destroys nothing.
bool is_same_file(const std::string& a, const std::string& b);

/// A file and its role in messages: "the scene", "the output".
struct NamedFile {
  std::string path;
  std::string role;
};

/// Throws InputError if `written` is the same file as one of `others`. Those with an empty path are ignored.
void refuse_same_file(const NamedFile& written, const std::vector<NamedFile>& others);

}  // namespace alhazen::impl
