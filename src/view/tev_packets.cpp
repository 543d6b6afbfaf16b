#include "view/tev_packets.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace alhazen::impl {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

class Writer {
 public:
  explicit Writer(TevPacketKind kind) {
    put(uint32_t{0});  // the length, when it is known
    put(static_cast<uint8_t>(kind));
  }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number value) {
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof(value));
    std::memcpy(bytes_.data() + at, &value, sizeof(value));
  }

  /// A name cannot contain the byte that ends it.
  void put(const std::string& text) {
    const auto end = std::find(text.begin(), text.end(), '\0');
    bytes_.insert(bytes_.end(), text.begin(), end);
    bytes_.push_back('\0');
  }

  void put(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) put(text);
  }

  TevPacket finish(std::vector<std::span<const float>> parts) && {
    TevPacket packet{std::move(bytes_), std::move(parts)};
    const auto length = static_cast<uint32_t>(packet.size());
    std::memcpy(packet.head.data(), &length, sizeof(length));
    return packet;
  }

 private:
  std::vector<char> bytes_;
};

constexpr uint8_t no = 0, yes = 1;

}  // namespace

size_t TevPacket::size() const {
  size_t bytes = head.size();
  for (const std::span<const float> part : parts) bytes += part.size_bytes();
  return bytes;
}

TevPacket tev_create_image(const std::string& name, const Image& image) {
  Writer packet(TevPacketKind::create_image);
  packet.put(yes);  // tev selects it
  packet.put(name);
  packet.put(int32_t{image.width});
  packet.put(int32_t{image.height});
  packet.put(static_cast<int32_t>(image.channels.size()));
  packet.put(image.channels);
  return std::move(packet).finish({});
}

TevPacket tev_update_image(const std::string& name, const Image& image, int y0, int y1) {
  const size_t width = static_cast<size_t>(image.width), first = static_cast<size_t>(y0) * width,
               pixels = static_cast<size_t>(y1 - y0) * width;
  Writer packet(TevPacketKind::update_image);
  packet.put(no);  // the user may be looking at another image
  packet.put(name);
  packet.put(static_cast<int32_t>(image.channels.size()));
  packet.put(image.channels);
  for (const int32_t number : {0, y0, image.width, y1 - y0}) packet.put(number);
  // Of each channel, in floats: where its first value is, and how far apart its values are.
  for (size_t c = 0; c < image.channels.size(); ++c) packet.put(static_cast<int64_t>(c * pixels));
  for (size_t c = 0; c < image.channels.size(); ++c) packet.put(int64_t{1});
  std::vector<std::span<const float>> parts;
  for (const std::vector<float>& plane : image.planes) parts.emplace_back(plane.data() + first, pixels);
  return std::move(packet).finish(std::move(parts));
}

int tev_rows_per_packet(const Image& image) {
  constexpr size_t wanted_bytes = size_t{1} << 19;
  const size_t row = std::max<size_t>(1, image.channels.size() * static_cast<size_t>(image.width) * sizeof(float));
  return static_cast<int>(std::clamp<size_t>(wanted_bytes / row, 1, static_cast<size_t>(std::max(1, image.height))));
}

}  // namespace alhazen::impl
