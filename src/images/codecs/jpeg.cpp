// Reads JPEG by stb_image, after checking the file's segments. By itself stb_image reads zeros past the end of a
// truncated file, takes as long as the scans of a malicious one require, and (up to version 2.27) trusts the counts of
// Huffman tables and decodes with tables that are missing in the file. So the check refuses such counts, and allocated
// memory is zeroed: a table of zeros decodes to zeros. Sums and shifts of bits may also overflow in damaged files; this
// file is compiled with -fwrapv, so that they only give wrong values.

#include <cstdlib>
#include <limits>
#include <memory>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_ASSERT(condition) static_cast<void>(0)
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#include <stb_image.h>

namespace alhazen::impl {

namespace {

constexpr int start_of_image = 0xd8, end_of_image = 0xd9, start_of_scan = 0xda, huffman_tables = 0xc4;

/// Progressive files have about ten scans; each is a pass over the whole image, however small it is in the file.
constexpr int max_scans = 100;

/// The next marker, after any entropy-coded data: in these 0xff is stuffed with 0, and restart markers (0xd0 to 0xd7)
/// are part of the data.
int next_marker(ByteReader& in) {
  while (true) {
    while (in.u8() != 0xff) {
    }
    int marker = in.u8();
    while (marker == 0xff) marker = in.u8();
    if (marker != 0 && (marker < 0xd0 || marker > 0xd7)) return marker;
  }
}

/// A segment of tables: each has a byte for its index, the counts of codes of 1 to 16 bits, and a symbol per code.
void check_huffman_tables(const std::string& path, std::span<const uint8_t> segment) {
  ByteReader in(path, segment);
  while (in.remaining() > 0) {
    in.skip(1);
    const auto counts = in.take(16);
    size_t codes = 0;
    for (const uint8_t count : counts) codes += count;
    if (codes > 256) in.fail("a Huffman table of the JPEG image has more than 256 codes; it is damaged");
    in.skip(codes);
  }
}

/// Checks the segments up to the end of the image; throws InputError if the file ends before.
void check_segments(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  int scans = 0;
  for (int marker = next_marker(in); marker != end_of_image; marker = next_marker(in)) {
    if (marker == start_of_image || marker == 1) continue;  // markers without a segment
    const size_t high = in.u8(), length = high << 8 | in.u8();
    if (length < 2) in.fail("a segment of the JPEG image has no length; it is damaged");
    const std::span<const uint8_t> segment = in.take(length - 2);
    if (marker == huffman_tables) check_huffman_tables(path, segment);
    if (marker == start_of_scan && ++scans > max_scans) in.fail("the JPEG image has more than 100 scans");
  }
}

}  // namespace

ImageTexels decode_jpeg(const std::string& path, std::span<const uint8_t> bytes) {
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
    throw_malformed(path, "a JPEG image of over 2 GiB is not supported");
  check_segments(path, bytes);
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const auto fail = [&] { throw_malformed(path, std::string("not a readable JPEG file: ") + stbi_failure_reason()); };
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) fail();
  check_size(path, width, height);
  check_plausible(path, uint64_t{3} * static_cast<uint64_t>(width) * static_cast<uint64_t>(height), bytes.size());
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3), stbi_image_free);
  if (!decoded) fail();

  ImageTexels texels{width, height, {}, {}, true, path};
  texels.bytes.assign(decoded.get(),
                      decoded.get() + size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
  return texels;
}

}  // namespace alhazen::impl
