#pragma once

// Buffers and buffer views, read on first use.

#include <map>
#include <span>
#include <vector>

#include "io/gltf/document.h"

namespace alhazen::impl::gltf {

struct BufferView {
  std::span<const uint8_t> bytes;
  size_t stride = 0;  ///< 0: tightly packed
};

class Buffers {
 public:
  explicit Buffers(const Document& document) : document_(document) {}

  /// The bytes of a buffer view, decompressed if it uses EXT_meshopt_compression. Spans remain valid.
  const BufferView& view(uint32_t index);
  /// Whether the file gives no data for the buffer of a view: neither "uri" nor the binary chunk. Its bytes are then 0.
  bool has_no_data(uint32_t view) const;

 private:
  std::span<const uint8_t> buffer(uint32_t index);
  bool is_without_data(uint32_t index) const;
  std::span<const uint8_t> zeros(uint32_t index, const Json& description, uint64_t length);
  std::span<const uint8_t> range(const Json& object);
  BufferView decompress(const Json& compression);

  const Document& document_;
  std::map<uint32_t, std::vector<uint8_t>> buffers_;
  uint64_t zero_bytes_ = 0;  ///< of all buffers without data so far
  std::map<uint32_t, BufferView> views_;
  std::map<uint32_t, std::vector<uint8_t>> decompressed_;
};

/// Decodes EXT_meshopt_compression: `compression` is the extension's object, `source` its bytes. Throws InputError,
/// also if the program was built without meshoptimizer.
std::vector<uint8_t> decode_meshopt(const Document& document, const Json& compression, std::span<const uint8_t> source);

}  // namespace alhazen::impl::gltf
