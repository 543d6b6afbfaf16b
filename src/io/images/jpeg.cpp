// JPEG input by stb_image, behind a check of the file's segments: stb_image reads zeros past the end of a truncated
// file and takes as long as the scans of a hostile one.

#include <limits>
#include <memory>

#include "io/images/byte_reader.h"
#include "io/images/decoders.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_ASSERT(condition) static_cast<void>(0)
#include <stb_image.h>

namespace alhazen {

namespace {

constexpr int start_of_image = 0xd8, end_of_image = 0xd9, start_of_scan = 0xda;

/// Progressive files have ten scans or so; each is a pass over the whole picture, however small it is in the file.
constexpr int max_scans = 100;

/// The next marker, past the entropy-coded data before it: there 0xff is stuffed with 0, and restart markers
/// (0xd0 to 0xd7) belong to the data.
int next_marker(ByteReader& in) {
  while (true) {
    while (in.u8() != 0xff) {
    }
    int marker = in.u8();
    while (marker == 0xff) marker = in.u8();
    if (marker != 0 && (marker < 0xd0 || marker > 0xd7)) return marker;
  }
}

/// Walks the segments to the end of the image; throws InputError where the file ends before.
void check_segments(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  int scans = 0;
  for (int marker = next_marker(in); marker != end_of_image; marker = next_marker(in)) {
    if (marker == start_of_image || marker == 1) continue;  // markers that stand alone
    const size_t high = in.u8(), length = high << 8 | in.u8();
    if (length < 2) in.fail("a segment of the JPEG picture has no length; it is damaged");
    in.skip(length - 2);
    if (marker == start_of_scan && ++scans > max_scans) in.fail("the JPEG picture has more than 100 scans");
  }
}

}  // namespace

ImageTexels decode_jpeg(const std::string& path, std::span<const uint8_t> bytes) {
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
    throw_malformed(path, "a JPEG picture of over 2 GiB is not supported");
  check_segments(path, bytes);
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const auto fail = [&] { throw_malformed(path, std::string("not a readable JPEG file: ") + stbi_failure_reason()); };
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) fail();
  check_declared_size(path, width, height, 3, bytes.size());
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3), stbi_image_free);
  if (!decoded) fail();

  ImageTexels texels{width, height, {}, {}, true, path};
  texels.bytes.assign(decoded.get(),
                      decoded.get() + size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
  return texels;
}

}  // namespace alhazen
