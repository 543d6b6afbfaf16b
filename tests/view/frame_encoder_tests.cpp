#include "view/frame_encoder.h"

#include <half.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "view/frame_decoder.h"
#include "view/half_bits.h"

namespace alhazen::impl::test {

namespace {

std::shared_ptr<Picture> random_picture(int width, int height, uint32_t seed) {
  auto picture = std::make_shared<Picture>();
  picture->width = picture->full_width = width;
  picture->height = picture->full_height = height;
  picture->number = seed;
  PictureLayer colour{"color", {"R", "G", "B"}, {}};
  std::mt19937 random(seed);
  std::lognormal_distribution<float> values(-1, 2);
  for (int c = 0; c < 3; ++c) {
    colour.planes.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (float& value : colour.planes.back()) value = values(random);
  }
  picture->layers.push_back(std::move(colour));
  return picture;
}

EncodedLayer encoded(const std::shared_ptr<Picture>& picture, FrameType type) {
  return {picture, picture->layers[0], type};
}

void expect_same(const std::vector<uint32_t>& decoded, const std::vector<float>& plane, FrameType type) {
  ASSERT_EQ(decoded.size(), plane.size());
  for (size_t i = 0; i < plane.size(); ++i)
    ASSERT_EQ(decoded[i], type == FrameType::single ? std::bit_cast<uint32_t>(plane[i]) : half(plane[i]).bits()) << i;
}

}  // namespace

TEST(HalfBits, AreThoseOfTheNearestHalf) {
  // Every half, what is halfway to the next, and what is next to both.
  for (uint32_t bits = 0; bits < 0x7c00; ++bits) {
    const float value = half(half::FromBits, static_cast<uint16_t>(bits));
    const float next =
        bits == 0x7bff ? 65536.0f : static_cast<float>(half(half::FromBits, static_cast<uint16_t>(bits + 1)));
    const float middle = 0.5f * value + 0.5f * next;
    for (const float near : {value, middle, std::nextafter(middle, 0.0f), std::nextafter(middle, 1e9f)})
      for (const float signed_value : {near, -near})
        ASSERT_EQ(half_bits(signed_value), half(signed_value).bits()) << signed_value;
    const uint32_t even = bits % 2 == 0 ? bits : bits + 1;
    ASSERT_EQ(half_bits(middle), even) << middle;
  }
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float value :
       {infinity, -infinity, 1e30f, 65520.0f, 65519.99f, 1e-30f, std::numeric_limits<float>::denorm_min()})
    EXPECT_EQ(half_bits(value), half(value).bits()) << value;
  const uint16_t nan = half_bits(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(nan & 0x7c00, 0x7c00);
  EXPECT_NE(nan & 0x3ff, 0);
}

TEST(FrameEncoder, FramesHaveTheValuesOfThePlanes) {
  for (const auto& [width, height] : {std::pair(200, 130), std::pair(64, 64), std::pair(1, 1), std::pair(63, 65)}) {
    const std::shared_ptr<Picture> picture = random_picture(width, height, 1);
    picture->layers[0].planes[0][0] = -0.0f;
    for (const FrameType type : {FrameType::half, FrameType::single}) {
      EncodedLayer layer = encoded(picture, type);
      const DecodedFrame frame = decode_frame(layer.frame({7, {}}, nullptr));
      for (size_t c = 0; c < 3; ++c) expect_same(frame.planes.at(c), picture->layers[0].planes[c], type);
      EXPECT_TRUE(frame.header["tiles"].is_null());
    }
  }
}

TEST(FrameEncoder, TheHeaderSaysWhatIsSeen) {
  const std::shared_ptr<Picture> picture = random_picture(10, 5, 1);
  picture->view = 3;
  picture->full_width = 80;
  picture->full_height = 40;
  picture->x = 16;
  picture->y = 8;
  picture->step = 8;
  picture->samples = 1.5;
  picture->is_final = true;
  EncodedLayer layer = encoded(picture, FrameType::half);
  const nlohmann::json header = decode_frame(layer.frame({12, 34}, nullptr)).header;
  const nlohmann::json expected{
      {"frame", 12}, {"view", 3},        {"camera_id", 34},        {"layer", "color"},  {"channels", {"R", "G", "B"}},
      {"width", 10}, {"height", 5},      {"full_width", 80},       {"full_height", 40}, {"x", 16},
      {"y", 8},      {"step", 8},        {"samples", 1.5},         {"final", true},     {"type", "half"},
      {"tile", 64},  {"tiles", nullptr}, {"bytes", 10 * 5 * 3 * 2}};
  EXPECT_EQ(header, expected);
  EXPECT_TRUE(decode_frame(layer.frame({12, {}}, nullptr)).header["camera_id"].is_null());
}

TEST(FrameEncoder, OnlyTilesThatChangedAreSent) {
  const std::shared_ptr<Picture> before = random_picture(200, 130, 1);
  const auto after = std::make_shared<Picture>(*before);
  after->layers[0].planes[1][199] += 1;               // tile 3
  after->layers[0].planes[2][129 * 200 + 64] = -1;    // tile 9
  after->layers[0].planes[0][64 * 200] *= 1.000001f;  // tile 4, within half precision
  for (const FrameType type : {FrameType::half, FrameType::single}) {
    EncodedLayer one = encoded(before, type), two = encoded(after, type);
    const DecodedFrame frame = decode_frame(two.frame({2, {}}, &one));
    EXPECT_EQ(frame.tiles, type == FrameType::half ? std::vector<size_t>({3, 9}) : std::vector<size_t>({3, 4, 9}));
    const DecodedFrame whole = decode_frame(two.frame({2, {}}, nullptr));
    for (size_t c = 0; c < 3; ++c) {
      expect_same(whole.planes[c], after->layers[0].planes[c], type);
      for (const size_t i : {size_t{199}, size_t{129 * 200 + 64}}) EXPECT_EQ(frame.planes[c][i], whole.planes[c][i]);
      EXPECT_EQ(frame.planes[c][0], 0u);
    }
    EncodedLayer same = encoded(before, type);
    const DecodedFrame nothing = decode_frame(same.frame({3, {}}, &one));
    EXPECT_TRUE(nothing.tiles.empty());
    EXPECT_EQ(nothing.header["tiles"], nlohmann::json::array());
  }
}

TEST(FrameEncoder, AnotherSizeOrTypeIsSentWhole) {
  const std::shared_ptr<Picture> picture = random_picture(100, 100, 1);
  EncodedLayer half_layer = encoded(picture, FrameType::half), single = encoded(picture, FrameType::single);
  EncodedLayer smaller = encoded(random_picture(50, 50, 1), FrameType::half);
  EXPECT_TRUE(decode_frame(half_layer.frame({1, {}}, &single)).header["tiles"].is_null());
  EXPECT_TRUE(decode_frame(half_layer.frame({1, {}}, &smaller)).header["tiles"].is_null());
}

TEST(FrameEncoder, Speed) {
  const std::shared_ptr<Picture> picture = random_picture(960, 540, 1);
  for (const FrameType type : {FrameType::half, FrameType::single}) {
    const auto start = std::chrono::steady_clock::now();
    EncodedLayer layer = encoded(picture, type);
    const auto planes = std::chrono::steady_clock::now();
    const std::string frame = layer.frame({1, {}}, nullptr);
    const auto end = std::chrono::steady_clock::now();
    const auto ms = [](auto duration) { return std::chrono::duration<double, std::milli>(duration).count(); };
    std::printf("960 x 540, %s: %.1f ms for byte planes, %.1f ms to compress, %zu of %zu bytes\n",
                type == FrameType::half ? "half" : "float", ms(planes - start), ms(end - planes), frame.size(),
                size_t{960 * 540 * 3} * (type == FrameType::half ? 2 : 4));
    EXPECT_LT(frame.size(), size_t{960 * 540 * 3} * (type == FrameType::half ? 2 : 4));
  }
}

}  // namespace alhazen::impl::test
