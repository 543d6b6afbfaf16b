#include "io/images/input_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace alhazen {

void throw_malformed(const std::string& path, const std::string& message) {
  throw InputError(SourceLocation{path, 0, 0}, message);
}

uint64_t checked_file_size(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw_malformed(path, "no such file");
  if (status.type() == std::filesystem::file_type::directory) throw_malformed(path, "is a folder, not a picture");
  if (error) throw_malformed(path, "cannot be read: " + error.message());
  if (status.type() != std::filesystem::file_type::regular) throw_malformed(path, "is not a regular file");
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw_malformed(path, "cannot be read: " + error.message());
  if (size == 0) throw_malformed(path, "the file is empty");
  return size;
}

std::vector<uint8_t> read_bytes(const std::string& path) {
  const uint64_t size = checked_file_size(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw_malformed(path, "cannot be opened: " + std::generic_category().message(errno));
  std::vector<uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (stream.gcount() != static_cast<std::streamsize>(size)) throw_malformed(path, "cannot be read to its end");
  return bytes;
}

void check_size(const std::string& path, int64_t width, int64_t height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width <= 0 || height <= 0) throw_malformed(path, "the header gives a size of " + size);
  if (height > max_texels / width) throw_malformed(path, "a picture of " + size + " is over the limit of 2^30 texels");
}

void check_plausible(const std::string& path, uint64_t decoded_bytes, uint64_t file_size) {
  // Deflate packs at most 1032 to 1, the other codecs stay below the factor too. A few megabytes are always fine.
  constexpr uint64_t largest_ratio = 4096, always_allowed = uint64_t{16} << 20;
  if (decoded_bytes > std::max(always_allowed, file_size * largest_ratio))
    throw_malformed(path, "the header declares a picture of " + std::to_string(decoded_bytes) +
                              " bytes, but the file has only " + std::to_string(file_size) +
                              "; it is truncated or damaged");
}

}  // namespace alhazen
