#pragma once

// Reads the binary messages of src/view/frame_encoder.h, by their description there.

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alhazen::impl::test {

struct DecodedFrame {
  nlohmann::json header;
  std::vector<std::vector<uint32_t>> planes;  ///< bits of the values, for each channel; 0 where no tile was sent
  std::vector<size_t> tiles;                  ///< that were sent
};

inline std::string inflated(const char* data, size_t size, size_t expected) {
  std::string bytes(expected + 1, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data));
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0u) << "there is something after the stream";
  bytes.resize(bytes.size() - stream.avail_out);
  inflateEnd(&stream);
  return bytes;
}

inline DecodedFrame decode_frame(const std::string& message) {
  DecodedFrame frame;
  EXPECT_EQ(message.substr(0, 4), "ALHF");
  size_t length = 0;
  for (size_t i = 0; i < 4; ++i) length |= size_t{static_cast<uint8_t>(message.at(4 + i))} << (8 * i);
  EXPECT_EQ(length % 4, 0u);
  frame.header = nlohmann::json::parse(message.substr(8, length));
  const auto& h = frame.header;
  const std::string payload = inflated(message.data() + 8 + length, message.size() - 8 - length, h["bytes"]);
  EXPECT_EQ(payload.size(), h["bytes"].get<size_t>());
  const size_t width = h["width"], height = h["height"], tile = h["tile"], size = h["type"] == "half" ? 2 : 4;
  const size_t columns = (width + tile - 1) / tile, rows = (height + tile - 1) / tile;
  if (h["tiles"].is_null())
    for (size_t i = 0; i < columns * rows; ++i) frame.tiles.push_back(i);
  else
    frame.tiles = h["tiles"].get<std::vector<size_t>>();
  frame.planes.assign(h["channels"].size(), std::vector<uint32_t>(width * height));
  size_t at = 0;
  for (const size_t index : frame.tiles) {
    const size_t x0 = index % columns * tile, y0 = index / columns * tile;
    const size_t x1 = std::min(width, x0 + tile), y1 = std::min(height, y0 + tile);
    for (auto& plane : frame.planes)
      for (size_t byte = 0; byte < size; ++byte)
        for (size_t y = y0; y < y1; ++y)
          for (size_t x = x0; x < x1; ++x)
            plane[y * width + x] |= uint32_t{static_cast<uint8_t>(payload.at(at++))} << (8 * byte);
  }
  EXPECT_EQ(at, payload.size());
  return frame;
}

}  // namespace alhazen::impl::test
