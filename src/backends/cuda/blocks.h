#pragma once

// The sizes of blocks of threads and the numbers of chunks that may be asked for.

#include <string>

#include "render/settings.h"

namespace alhazen::cuda {

/// Parses `16x16`: a block that a GPU can run. Throws InputError.
BlockSize parse_block(const std::string& text);
/// Parses `4x4`: chunks in each direction. Throws InputError.
BlockSize parse_chunks(const std::string& text);
std::string to_string(const BlockSize& size);

}  // namespace alhazen::cuda
