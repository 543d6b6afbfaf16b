#include "backends/cuda/blocks.h"

#include <array>

#include "util/diagnostics.h"
#include "util/parse_numbers.h"

namespace alhazen::impl::cuda {

namespace {

BlockSize parse_size(const std::string& text, const std::string& what, uint32_t max_side) {
  std::array<uint32_t, 2> sides;
  const auto fits = [&](uint32_t side) { return side >= 1 && side <= max_side; };
  if (!parse_numbers(text, 'x', sides) || !fits(sides[0]) || !fits(sides[1]))
    throw InputError(what + " must be WIDTHxHEIGHT, each between 1 and " + std::to_string(max_side) +
                     ", for example 16x16, not '" + text + "'");
  return {sides[0], sides[1]};
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

}  // namespace alhazen::impl::cuda
