#include "images/display/display_transform.h"

#include <cmath>

#include "images/display/tone_map.h"

namespace alhazen::impl {

void make_straight(std::span<float> row, const std::array<size_t, 3>& channels, size_t alpha, size_t width) {
  for (size_t x = 0; x < width; ++x)
    if (const float a = row[alpha * width + x]; a > 0)
      for (const size_t c : channels) row[c * width + x] /= a;
}

DisplayTransform::DisplayTransform(const WriteOptions& options)
    : factor_(std::exp2(options.exposure)),
      balances_(options.white_temperature > 0),
      balance_(options.white_temperature),
      tone_map_(options.tone_map) {}

Vec3d DisplayTransform::operator()(const Vec3d& radiance) const {
  Vec3d colour = factor_ * radiance;
  // A sum with a channel that is not finite would not be finite either, or not a number.
  if (balances_ && is_finite(colour)) colour = balance_(colour);
  colour = tone_map(colour, tone_map_);
  return {srgb_encode(colour.x), srgb_encode(colour.y), srgb_encode(colour.z)};
}

void DisplayTransform::encode_row(std::span<const float> row, const std::array<size_t, 3>& channels, unsigned largest,
                                  std::span<uint16_t> encoded) const {
  const size_t width = encoded.size() / 3;
  for (size_t x = 0; x < width; ++x) {
    const auto value = [&](size_t c) { return static_cast<double>(row[channels[c] * width + x]); };
    const Vec3d shown = (*this)({value(0), value(1), value(2)});
    for (int c = 0; c < 3; ++c)
      encoded[3 * x + static_cast<size_t>(c)] = static_cast<uint16_t>(std::floor(largest * shown[c] + 0.5));
  }
}

}  // namespace alhazen::impl
