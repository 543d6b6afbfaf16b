#include "backends/cuda/blocks.h"

#include <charconv>

#include "util/diagnostics.h"

namespace alhazen::cuda {

namespace {

BlockSize parse_size(const std::string& text, const std::string& what, uint32_t most) {
  BlockSize size;
  const char* const end = text.data() + text.size();
  const auto [after_x, x_error] = std::from_chars(text.data(), end, size.x);
  if (x_error == std::errc() && after_x != end && *after_x == 'x') {
    const auto [after_y, y_error] = std::from_chars(after_x + 1, end, size.y);
    if (y_error == std::errc() && after_y == end && size.x >= 1 && size.y >= 1 && size.x <= most && size.y <= most)
      return size;
  }
  throw InputError(what + " must be WIDTHxHEIGHT, each between 1 and " + std::to_string(most) +
                   ", for example 16x16, not '" + text + "'");
}

}  // namespace

BlockSize parse_block(const std::string& text) {
  constexpr uint32_t max_threads = 1024;
  const BlockSize block = parse_size(text, "the block", max_threads);
  if (block.x * block.y > max_threads)
    throw InputError("a block of " + text + " is " + std::to_string(block.x * block.y) +
                     " threads; a GPU runs at most 1024 in one: give fewer, for example 16x16");
  return block;
}

BlockSize parse_chunks(const std::string& text) { return parse_size(text, "the number of chunks", 4096); }

std::string to_string(const BlockSize& size) { return std::to_string(size.x) + "x" + std::to_string(size.y); }

}  // namespace alhazen::cuda
