#include "io/gltf/buffers.h"

#include "io/gltf/uri.h"

namespace alhazen::impl::gltf {

namespace {

/// Bytes of all buffers without data; a file of a few bytes must not take all memory.
constexpr uint64_t max_zero_bytes = uint64_t{1} << 28;

}  // namespace

/// The first buffer of a .glb file has its chunk or is malformed.
bool Buffers::is_without_data(uint32_t index) const {
  return document_.item("buffers", index).find("uri") == nullptr && !(index == 0 && document_.is_binary());
}

bool Buffers::has_no_data(uint32_t view) const {
  return is_without_data(document_.required_index(document_.item("bufferViews", view), "buffer", "buffers"));
}

/// The bytes of a buffer without data.
std::span<const uint8_t> Buffers::zeros(uint32_t index, const Json& description, uint64_t length) {
  if (const auto entry = buffers_.find(index); entry != buffers_.end()) return entry->second;
  if (length > max_zero_bytes - zero_bytes_)
    document_.fail(description, "the buffer of " + std::to_string(length) + " bytes has no data: it needs a \"uri\"");
  zero_bytes_ += length;
  document_.warn(description,
                 "the buffer has no data, neither a \"uri\" nor the binary chunk of a .glb file: its "
                 "bytes are read as 0, and what is made of them is not seen");
  return buffers_.try_emplace(index, static_cast<size_t>(length)).first->second;
}

std::span<const uint8_t> Buffers::buffer(uint32_t index) {
  const Json& description = document_.item("buffers", index);
  const uint64_t length = document_.required_whole(description, "byteLength");
  const Json* uri = description.find("uri");
  std::span<const uint8_t> bytes;
  if (uri != nullptr) {
    auto entry = buffers_.find(index);
    if (entry == buffers_.end()) entry = buffers_.emplace(index, load_uri(document_, *uri).bytes).first;
    bytes = entry->second;
  } else if (is_without_data(index)) {
    bytes = zeros(index, description, length);
  } else if (document_.binary_chunk()) {
    bytes = *document_.binary_chunk();
  } else {
    document_.fail(description, "the buffer has no data: the .glb file has no binary chunk");
  }
  if (bytes.size() < length)
    document_.fail(description,
                   "the buffer must have " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()));
  return bytes.first(static_cast<size_t>(length));
}

std::span<const uint8_t> Buffers::range(const Json& object) {
  const std::span<const uint8_t> bytes = buffer(document_.required_index(object, "buffer", "buffers"));
  const uint64_t offset = document_.whole(object, "byteOffset").value_or(0);
  const uint64_t length = document_.required_whole(object, "byteLength");
  if (offset > bytes.size() || length > bytes.size() - offset)
    document_.fail(object, "the buffer view ends at byte " + std::to_string(offset + length) + " of a buffer of " +
                               std::to_string(bytes.size()) + " bytes");
  return bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

const BufferView& Buffers::view(uint32_t index) {
  if (const auto entry = views_.find(index); entry != views_.end()) return entry->second;
  const Json& description = document_.item("bufferViews", index);
  const Json* compression = document_.extension(description, "EXT_meshopt_compression");
  if (compression == nullptr) compression = document_.extension(description, "KHR_meshopt_compression");
  BufferView view;
  if (compression != nullptr) {
    decompressed_[index] = decode_meshopt(document_, *compression, range(*compression));
    view.bytes = decompressed_[index];
    view.stride = static_cast<size_t>(document_.required_whole(*compression, "byteStride"));
  } else {
    view.bytes = range(description);
    view.stride = static_cast<size_t>(document_.whole(description, "byteStride").value_or(0));
    if (view.stride != 0 && (view.stride < 4 || view.stride > 252))
      document_.fail(description, "\"byteStride\" must be from 4 to 252, not " + std::to_string(view.stride));
  }
  return views_.emplace(index, view).first->second;
}

}  // namespace alhazen::impl::gltf
