#include "images/codecs/image_bytes.h"

#include <algorithm>

namespace alhazen::impl {

void throw_malformed(const std::string& path, const std::string& message) {
  throw InputError(SourceLocation{path, 0, 0}, message);
}

std::vector<uint8_t> read_bytes(const InputPath& path) {
  InputFile file(path);
  if (file.size() == 0) throw_malformed(path.name, "the file is empty");
  return file.read_all();
}

void check_size(const std::string& path, int64_t width, int64_t height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width <= 0 || height <= 0) throw_malformed(path, "the header gives a size of " + size);
  if (height > max_texels / width) throw_malformed(path, "an image of " + size + " is over the limit of 2^30 texels");
}

void check_plausible(const std::string& path, uint64_t decoded_bytes, uint64_t file_size) {
  // Deflate compresses at most 1032 to 1, and the other codecs also stay below this factor. A few megabytes are always
  // fine.
  constexpr uint64_t max_ratio = 4096, always_allowed = uint64_t{16} << 20;
  if (decoded_bytes > std::max(always_allowed, file_size * max_ratio))
    throw_malformed(path, "the header declares an image of " + std::to_string(decoded_bytes) +
                              " bytes, but the file has only " + std::to_string(file_size) +
                              "; it is truncated or damaged");
}

}  // namespace alhazen::impl
