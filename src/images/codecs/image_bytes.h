#pragma once

// The bytes of a picture on disk, and the bounds that keep a hostile one from taking all memory.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/input_file.h"
#include "util/diagnostics.h"

namespace alhazen {

inline constexpr int64_t max_texels = int64_t{1} << 30;

/// Throws InputError where `path` is not a readable regular file, or an empty one.
std::vector<uint8_t> read_bytes(const InputPath& path);

// The next two are called with what a header declares, before anything of that size is allocated.

/// Throws InputError where the size is empty or over `max_texels`.
void check_size(const std::string& path, int64_t width, int64_t height);

/// Throws InputError where `decoded_bytes` are beyond all that a file of `file_size` bytes could hold, compressed.
void check_plausible(const std::string& path, uint64_t decoded_bytes, uint64_t file_size);

[[noreturn]] void throw_malformed(const std::string& path, const std::string& message);

}  // namespace alhazen
