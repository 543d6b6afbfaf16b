#pragma once

// The bytes of an image file, and limits that prevent malicious files from exhausting memory.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/input_file.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

inline constexpr int64_t max_texels = int64_t{1} << 30;

/// Throws InputError if `path` is not a readable regular file, or empty.
std::vector<uint8_t> read_bytes(const InputPath& path);

// The next two check what a header declares before anything of that size is allocated.

/// Throws InputError if the size is empty or over `max_texels`.
void check_size(const std::string& path, int64_t width, int64_t height);

/// Throws InputError if a file of `file_size` bytes could not hold `decoded_bytes` even when compressed.
void check_plausible(const std::string& path, uint64_t decoded_bytes, uint64_t file_size);

[[noreturn]] void throw_malformed(const std::string& path, const std::string& message);

}  // namespace alhazen::impl
