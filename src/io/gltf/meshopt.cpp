// EXT_meshopt_compression, by the meshoptimizer library.

#include "io/gltf/buffers.h"
#include "util/quoted.h"

#ifdef ALHAZEN_WITH_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace alhazen::impl::gltf {

#ifdef ALHAZEN_WITH_MESHOPTIMIZER

namespace {

struct CompressedLayout {
  uint64_t count = 0, stride = 0;
  std::string mode, filter;
};

CompressedLayout read_layout(const Document& document, const Json& compression, size_t source_bytes) {
  CompressedLayout layout{document.required_whole(compression, "count"),
                          document.required_whole(compression, "byteStride"), document.string(compression, "mode"),
                          document.string(compression, "filter", "NONE")};
  const auto bad = [&](const std::string& message) { document.fail(compression, message); };
  const bool is_attributes = layout.mode == "ATTRIBUTES";
  if (!is_attributes && layout.mode != "TRIANGLES" && layout.mode != "INDICES")
    bad("unknown mode " + quoted(layout.mode) + " of compression: it may be ATTRIBUTES, TRIANGLES or INDICES");
  if (is_attributes ? layout.stride % 4 != 0 || layout.stride == 0 || layout.stride > 256
                    : layout.stride != 2 && layout.stride != 4)
    bad("a \"byteStride\" of " + std::to_string(layout.stride) + " cannot be decompressed");
  if (layout.mode == "TRIANGLES" && layout.count % 3 != 0) bad("\"count\" must be a multiple of 3 for triangles");
  // Both codecs have a minimum size: a header of 2 bits per 16 bytes of attributes, and a byte per triangle or index.
  // So a small file cannot request all memory.
  const uint64_t max_items = is_attributes ? 256 * uint64_t{source_bytes} : 3 * uint64_t{source_bytes};
  if (layout.count > (uint64_t{1} << 31) || layout.count > max_items)
    bad("the compressed data are too short for " + std::to_string(layout.count) + " items");
  return layout;
}

void apply_filter(const Document& document, const Json& compression, const CompressedLayout& layout,
                  std::vector<uint8_t>& bytes) {
  const size_t count = static_cast<size_t>(layout.count), stride = static_cast<size_t>(layout.stride);
  const auto require = [&](bool fits) {
    if (!fits)
      document.fail(compression,
                    "the filter " + layout.filter + " does not support a \"byteStride\" of " + std::to_string(stride));
  };
  if (layout.filter == "OCTAHEDRAL") {
    require(stride == 4 || stride == 8);
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  } else if (layout.filter == "QUATERNION") {
    require(stride == 8);
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  } else if (layout.filter == "EXPONENTIAL") {
    require(stride % 4 == 0);
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  } else if (layout.filter != "NONE") {
    document.fail(compression, "the filter " + quoted(layout.filter) +
                                   " is not supported: NONE, OCTAHEDRAL, QUATERNION and EXPONENTIAL are");
  }
}

}  // namespace

std::vector<uint8_t> decode_meshopt(const Document& document, const Json& compression,
                                    std::span<const uint8_t> source) {
  const CompressedLayout layout = read_layout(document, compression, source.size());
  const size_t count = static_cast<size_t>(layout.count), stride = static_cast<size_t>(layout.stride);
  std::vector<uint8_t> bytes(count * stride);
  if (count == 0) return bytes;
  int error = 0;
  if (layout.mode == "ATTRIBUTES")
    error = meshopt_decodeVertexBuffer(bytes.data(), count, stride, source.data(), source.size());
  else if (layout.mode == "TRIANGLES")
    error = meshopt_decodeIndexBuffer(bytes.data(), count, stride, source.data(), source.size());
  else
    error = meshopt_decodeIndexSequence(bytes.data(), count, stride, source.data(), source.size());
  if (error != 0)
    document.fail(compression, "the data compressed by meshoptimizer are damaged or of an unknown version");
  apply_filter(document, compression, layout, bytes);
  return bytes;
}

#else

std::vector<uint8_t> decode_meshopt(const Document& document, const Json& compression, std::span<const uint8_t>) {
  document.fail(compression,
                "the file is compressed by meshoptimizer, and this program was built without that library: install "
                "libmeshoptimizer-dev and build again");
}

#endif

}  // namespace alhazen::impl::gltf
