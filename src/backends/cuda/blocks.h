#pragma once

// Parses block sizes and numbers of chunks.

#include <string>

#include "render/settings.h"

namespace alhazen::impl::cuda {

/// Parses a block size such as `16x16`, in threads. Throws InputError unless a GPU can run such a block.
BlockSize parse_block(const std::string& text);
/// Parses numbers of chunks in x and y such as `4x4`. Throws InputError.
BlockSize parse_chunks(const std::string& text);
std::string to_string(const BlockSize& size);

}  // namespace alhazen::impl::cuda
