#include "view/frame_encoder.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "view/half_bits.h"

namespace alhazen::impl {

namespace {

constexpr size_t size_of(FrameType type) { return type == FrameType::half ? 2 : 4; }

/// Stores the bytes of a row at `to`, and of each next byte `stride` bytes further.
void add_bytes(const float* row, size_t count, FrameType type, uint8_t* to, size_t stride) {
  if (type == FrameType::half) {
    uint8_t* const high = to + stride;
    for (size_t i = 0; i < count; ++i) {
      const uint16_t bits = half_bits(row[i]);
      to[i] = static_cast<uint8_t>(bits);
      high[i] = static_cast<uint8_t>(bits >> 8);
    }
    return;
  }
  for (unsigned byte = 0; byte < 4; ++byte, to += stride)
    for (size_t i = 0; i < count; ++i) to[i] = static_cast<uint8_t>(std::bit_cast<uint32_t>(row[i]) >> (8 * byte));
}

/// Compresses one piece after another, each such that what is before it is not needed, and that pieces can be put
/// together to one stream: a piece ends with an empty block of whole bytes.
class PieceCompressor {
 public:
  PieceCompressor() {
    constexpr int fastest = 1, raw = -15, most_memory = 9;
    if (deflateInit2(&stream_, fastest, Z_DEFLATED, raw, most_memory, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~PieceCompressor() { deflateEnd(&stream_); }
  PieceCompressor(const PieceCompressor&) = delete;
  PieceCompressor& operator=(const PieceCompressor&) = delete;

  std::string compress(const uint8_t* data, size_t size) {
    deflateReset(&stream_);
    buffer_.resize(deflateBound(&stream_, static_cast<uLong>(size)) + 16);
    stream_.next_in = const_cast<Bytef*>(data);
    stream_.avail_in = static_cast<uInt>(size);
    stream_.next_out = buffer_.data();
    stream_.avail_out = static_cast<uInt>(buffer_.size());
    if (deflate(&stream_, Z_SYNC_FLUSH) != Z_OK || stream_.avail_in != 0 || stream_.avail_out == 0)
      throw std::logic_error("a tile does not fit into the bound of its compressed size");
    return {reinterpret_cast<const char*>(buffer_.data()), buffer_.size() - stream_.avail_out};
  }

 private:
  z_stream stream_{};
  std::vector<uint8_t> buffer_;
};

/// An empty block that is the last of a stream.
constexpr char last_block[] = {3, 0};

}  // namespace

EncodedLayer::EncodedLayer(std::shared_ptr<const Picture> picture, const PictureLayer& layer, FrameType type)
    : picture_(std::move(picture)), layer_(layer), type_(type) {
  const size_t pixels = static_cast<size_t>(picture_->width) * static_cast<size_t>(picture_->height);
  bytes_.resize(pixels * layer.planes.size() * size_of(type));
  for (int y = 0; y < picture_->height; y += tile_size)
    for (int x = 0; x < picture_->width; x += tile_size) add_tile(x, y);
}

void EncodedLayer::add_tile(int x0, int y0) {
  const size_t stride = static_cast<size_t>(picture_->width), x = static_cast<size_t>(x0), y = static_cast<size_t>(y0);
  const size_t columns = static_cast<size_t>(std::min(tile_size, picture_->width - x0));
  const size_t rows = static_cast<size_t>(std::min(tile_size, picture_->height - y0));
  const size_t pixels = columns * rows;
  const size_t begin = tiles_.empty() ? 0 : tiles_.back().begin + tiles_.back().size;
  uint8_t* to = bytes_.data() + begin;
  for (const std::vector<float>& plane : layer_.planes) {
    for (size_t row = 0; row < rows; ++row)
      add_bytes(plane.data() + (y + row) * stride + x, columns, type_, to + row * columns, pixels);
    to += pixels * size_of(type_);
  }
  tiles_.push_back({begin, pixels * layer_.planes.size() * size_of(type_), {}});
}

bool EncodedLayer::is_comparable(const EncodedLayer& other) const {
  return type_ == other.type_ && layer_.channels == other.layer_.channels && picture_->width == other.picture_->width &&
         picture_->height == other.picture_->height;
}

std::vector<size_t> EncodedLayer::changed_tiles(const EncodedLayer& previous) const {
  std::vector<size_t> changed;
  for (size_t i = 0; i < tiles_.size(); ++i) {
    const size_t begin = tiles_[i].begin;
    if (std::memcmp(bytes_.data() + begin, previous.bytes_.data() + begin, tiles_[i].size) != 0) changed.push_back(i);
  }
  return changed;
}

void EncodedLayer::compress(const std::vector<size_t>& tiles) {
  std::optional<PieceCompressor> compressor;
  for (const size_t i : tiles) {
    Tile& tile = tiles_[i];
    if (!tile.compressed.empty()) continue;
    if (!compressor) compressor.emplace();
    tile.compressed = compressor->compress(bytes_.data() + tile.begin, tile.size);
  }
}

std::string EncodedLayer::header(const FrameLabel& label, const std::vector<size_t>& sent, size_t bytes) const {
  const Picture& p = *picture_;
  nlohmann::ordered_json json{
      {"frame", label.frame},
      {"view", p.view},
      {"camera_id", nullptr},
      {"layer", layer_.name},
      {"channels", layer_.channels},
      {"width", p.width},
      {"height", p.height},
      {"full_width", p.full_width},
      {"full_height", p.full_height},
      {"x", p.x},
      {"y", p.y},
      {"step", p.step},
      {"samples", p.samples},
      {"final", p.is_final},
      {"type", type_ == FrameType::half ? "half" : "float"},
      {"tile", tile_size},
      {"tiles", nullptr},
      {"bytes", bytes},
  };
  if (label.camera_id) json["camera_id"] = *label.camera_id;
  if (sent.size() < tiles_.size()) json["tiles"] = sent;
  std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

std::string EncodedLayer::frame(const FrameLabel& label, const EncodedLayer* previous) {
  std::vector<size_t> sent;
  if (previous && is_comparable(*previous)) {
    sent = changed_tiles(*previous);
  } else {
    for (size_t i = 0; i < tiles_.size(); ++i) sent.push_back(i);
  }
  compress(sent);
  size_t bytes = 0, compressed = sizeof last_block;
  for (const size_t i : sent) {
    bytes += tiles_[i].size;
    compressed += tiles_[i].compressed.size();
  }
  const std::string head = header(label, sent, bytes);
  std::string message = "ALHF";
  message.reserve(8 + head.size() + compressed);
  for (unsigned byte = 0; byte < 4; ++byte) message += static_cast<char>(head.size() >> (8 * byte));
  message += head;
  for (const size_t i : sent) message += tiles_[i].compressed;
  message.append(last_block, sizeof last_block);
  return message;
}

}  // namespace alhazen::impl
