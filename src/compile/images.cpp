#include "compile/images.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alhazen::impl {

namespace {

double decoded(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double encoded(double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

/// Converts between bytes and linear values by tables.
struct ByteCodec {
  static constexpr int steps = 1 << 16;
  std::array<float, 256> values;
  std::vector<uint8_t> bytes;

  explicit ByteCodec(bool srgb) : bytes(steps + 1) {
    for (size_t i = 0; i < values.size(); ++i) {
      const double v = static_cast<double>(i) / 255;
      values[i] = static_cast<float>(srgb ? decoded(v) : v);
    }
    for (size_t i = 0; i < bytes.size(); ++i) {
      const double v = static_cast<double>(i) / steps;
      bytes[i] = static_cast<uint8_t>(std::lround(255 * (srgb ? encoded(v) : v)));
    }
  }
  uint8_t byte(float value) const {
    return bytes[static_cast<size_t>(std::clamp(value, 0.0f, 1.0f) * float{steps} + 0.5f)];
  }
};

const ByteCodec& codec_of(bool srgb) {
  static const ByteCodec linear(false), curved(true);
  return srgb ? curved : linear;
}

/// The texels of a row or column that contribute to a texel of half the resolution, and their weights.
struct Taps {
  int first = 0, count = 0;
  float weight[4] = {};
};

std::vector<Taps> taps_of(int from, int to) {
  std::vector<Taps> taps(static_cast<size_t>(to));
  const double ratio = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    Taps& t = taps[static_cast<size_t>(i)];
    const double low = i * ratio, high = (i + 1) * ratio;
    t.first = static_cast<int>(low);
    for (int k = t.first; k < from && k < high - 1e-9 && t.count < 4; ++k)
      t.weight[t.count++] = static_cast<float>(
          (std::min(high, static_cast<double>(k + 1)) - std::max(low, static_cast<double>(k))) / ratio);
  }
  return taps;
}

/// `value(texel, channel)` returns linear values; `keep(index, value)` receives the means.
template <class Value, class Keep>
void take_means(const ImageTexels& image, int width, int height, const Value& value, const Keep& keep) {
  const std::vector<Taps> columns = taps_of(image.width, width), rows = taps_of(image.height, height);
  const size_t channels = static_cast<size_t>(image.channels);
#pragma omp parallel for if (height > 64)
  for (int y = 0; y < height; ++y) {
    const Taps& row = rows[static_cast<size_t>(y)];
    for (int x = 0; x < width; ++x) {
      const Taps& column = columns[static_cast<size_t>(x)];
      for (size_t c = 0; c < channels; ++c) {
        float sum = 0;
        for (int j = 0; j < row.count; ++j) {
          const size_t first = static_cast<size_t>(row.first + j) * static_cast<size_t>(image.width);
          float along = 0;
          for (int i = 0; i < column.count; ++i)
            along += column.weight[i] * value((first + static_cast<size_t>(column.first + i)) * channels + c);
          sum += row.weight[j] * along;
        }
        keep((static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) * channels + c, sum);
      }
    }
  }
}

size_t values_of(const ImageTexels& image) {
  return static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * static_cast<size_t>(image.channels);
}

/// Bytes with the pyramid, which takes a third more.
uint64_t bytes_of(const ImageTexels& image) {
  return values_of(image) * (image.floats.empty() ? 1 : sizeof(float)) * 4 / 3;
}

template <class Value>
bool is_grey(const std::vector<Value>& values) {
  for (size_t i = 0; i + 2 < values.size(); i += 3)
    if (values[i] != values[i + 1] || values[i] != values[i + 2]) return false;
  return true;
}

template <class Value>
void keep_one_channel(std::vector<Value>& values) {
  for (size_t i = 0; 3 * i < values.size(); ++i) values[i] = values[3 * i];
  values.resize(values.size() / 3);
}

/// Stores a grey image as a single channel, in a third of the memory.
void reduce_grey(ImageTexels& image) {
  if (image.channels != 3 || !(image.floats.empty() ? is_grey(image.bytes) : is_grey(image.floats))) return;
  keep_one_channel(image.bytes);
  keep_one_channel(image.floats);
  image.channels = 1;
}

}  // namespace

ImageTexels halved(const ImageTexels& image) {
  ImageTexels half{
      std::max(image.width / 2, 1), std::max(image.height / 2, 1), {}, {}, image.srgb, image.name, image.channels};
  if (!image.floats.empty()) {
    half.floats.resize(values_of(half));
    take_means(
        image, half.width, half.height, [&](size_t i) { return image.floats[i]; },
        [&](size_t i, float value) { half.floats[i] = value; });
    return half;
  }
  const ByteCodec& codec = codec_of(image.srgb);
  half.bytes.resize(values_of(half));
  take_means(
      image, half.width, half.height, [&](size_t i) { return codec.values[image.bytes[i]]; },
      [&](size_t i, float value) { half.bytes[i] = codec.byte(value); });
  return half;
}

void fit_images(Scene& scene, uint64_t budget, Diagnostics& diagnostics) {
  if (budget == 0 || scene.images.empty()) return;
  const auto total = [&] {
    uint64_t sum = 0;
    for (const ImageTexels& image : scene.images) sum += bytes_of(image);
    return sum;
  };
  const uint64_t before = total();
  if (before <= budget) return;
  std::vector<bool> was_halved(scene.images.size());
  while (total() > budget) {
    const auto largest =
        std::max_element(scene.images.begin(), scene.images.end(),
                         [](const ImageTexels& a, const ImageTexels& b) { return bytes_of(a) < bytes_of(b); });
    if (largest->width <= 1 && largest->height <= 1) break;
    *largest = halved(*largest);
    was_halved[static_cast<size_t>(largest - scene.images.begin())] = true;
  }
  diagnostics.warn({scene.name}, "the texture images take " + std::to_string(before >> 20) +
                                     " MiB, more than the budget of " + std::to_string(budget >> 20) + " MiB; " +
                                     std::to_string(std::count(was_halved.begin(), was_halved.end(), true)) + " of " +
                                     std::to_string(scene.images.size()) + " were made smaller");
}

std::vector<bool> filtered_images(const Scene& scene) {
  std::vector<bool> is_filtered(scene.images.size());
  for (const Texture& texture : scene.textures)
    if (texture.kind == TextureKind::image && !texture.nearest && texture.image < is_filtered.size())
      is_filtered[texture.image] = true;
  return is_filtered;
}

template <class Real>
ImageBuilder<Real>::ImageBuilder(Scene& scene, SceneArrays<Real>& out) : out_(out) {
  const std::vector<bool> is_filtered = filtered_images(scene);
  for (size_t i = 0; i < scene.images.size(); ++i) add(scene.images[i], is_filtered[i]);
}

template <class Real>
ImageBuilder<Real>::ImageBuilder(std::vector<ImagePyramid> pyramids, SceneArrays<Real>& out)
    : out_(out), pyramids_(std::move(pyramids)) {}

template <class Real>
ImagePyramid::Level ImageBuilder<Real>::append(const ImageTexels& image) {
  const bool is_float = !image.floats.empty();
  const ImagePyramid::Level level{is_float ? out_.texel_floats.size() : out_.texel_bytes.size(),
                                  static_cast<uint32_t>(image.width), static_cast<uint32_t>(image.height)};
  out_.texel_bytes.insert(out_.texel_bytes.end(), image.bytes.begin(), image.bytes.end());
  out_.texel_floats.insert(out_.texel_floats.end(), image.floats.begin(), image.floats.end());
  return level;
}

template <class Real>
void ImageBuilder<Real>::add(ImageTexels& image, bool with_pyramid) {
  const size_t values = image.width > 0 && image.height > 0 ? values_of(image) : 0;
  const bool is_float = !image.floats.empty();
  if ((image.channels != 1 && image.channels != 3) || values == 0 ||
      (is_float ? image.floats.size() : image.bytes.size()) != values)
    throw InputError({image.name}, "the image does not hold width * height * channels values, of 1 or 3 channels");
  reduce_grey(image);
  ImagePyramid pyramid{{append(image)}, is_float, image.srgb, static_cast<uint32_t>(image.channels)};
  while (with_pyramid && (image.width > 1 || image.height > 1)) {
    image = halved(image);
    pyramid.levels.push_back(append(image));
  }
  std::vector<uint8_t>().swap(image.bytes);
  std::vector<float>().swap(image.floats);
  pyramids_.push_back(std::move(pyramid));
}

template <class Real>
uint32_t ImageBuilder<Real>::record(const Texture& texture) {
  if (texture.image >= pyramids_.size())
    throw InputError("texture '" + texture.name + "': image index is out of range");
  const WrapMode wrap_t = texture.wrap_t.value_or(texture.wrap);
  const auto [known, is_new] = records_.try_emplace({texture.image, texture.wrap, wrap_t, texture.nearest},
                                                    static_cast<uint32_t>(out_.images.size()));
  if (!is_new) return known->second;
  const ImagePyramid& pyramid = pyramids_[texture.image];
  const size_t levels = texture.nearest ? 1 : pyramid.levels.size();
  for (size_t i = 0; i < levels; ++i) {
    const ImagePyramid::Level& level = pyramid.levels[i];
    out_.images.push_back({level.first, level.width, level.height, pyramid.is_float ? 1u : 0u,
                           pyramid.is_srgb ? 1u : 0u, static_cast<uint32_t>(texture.wrap),
                           static_cast<uint32_t>(wrap_t), texture.nearest ? 1u : 0u, pyramid.channels,
                           static_cast<uint32_t>(levels - i), 0u});
  }
  return known->second;
}

template class ImageBuilder<float>;
template class ImageBuilder<double>;

}  // namespace alhazen::impl
