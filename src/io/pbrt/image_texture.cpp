#include "io/pbrt/image_texture.h"

#include <array>
#include <cmath>
#include <utility>

#include "io/images/image.h"
#include "io/images/texture.h"

namespace alhazen::pbrt {

namespace {

/// Decodes 8-bit values; the curve is called 256 times, not once a texel.
class ByteDecoder {
 public:
  explicit ByteDecoder(bool srgb) {
    for (size_t i = 0; i < 256; ++i) {
      const double encoded = static_cast<double>(i) / 255;
      values_[i] = srgb ? srgb_decode(encoded) : encoded;
    }
  }
  double operator()(uint8_t byte) const { return values_[byte]; }

 private:
  std::array<double, 256> values_{};
};

Vec3d texel(const ImageTexels& image, const ByteDecoder& decode, size_t index) {
  if (image.floats.empty())
    return {decode(image.bytes[3 * index]), decode(image.bytes[3 * index + 1]), decode(image.bytes[3 * index + 2])};
  return {static_cast<double>(image.floats[3 * index]), static_cast<double>(image.floats[3 * index + 1]),
          static_cast<double>(image.floats[3 * index + 2])};
}

template <class Value>
bool is_grey(const std::vector<Value>& values) {
  for (size_t i = 0; i + 2 < values.size(); i += 3)
    if (values[i] != values[i + 1] || values[i] != values[i + 2]) return false;
  return true;
}

/// A float texture is the mean of the three linear channels. Pictures that are grey keep their bytes.
void make_grey(ImageTexels& image) {
  if (image.floats.empty() ? is_grey(image.bytes) : is_grey(image.floats)) return;
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  const ByteDecoder decode(image.srgb);
  std::vector<float> grey(count);
  for (size_t i = 0; i < count; ++i) {
    const Vec3d colour = texel(image, decode, i);
    grey[i] = static_cast<float>((colour.x + colour.y + colour.z) / 3);
  }
  image.channels = 1;
  image.bytes = {};
  image.floats = std::move(grey);
}

TextureEncoding read_encoding(Build& build, ParameterList& list) {
  const std::string encoding = list.string("encoding", "");
  if (encoding.empty()) return TextureEncoding::automatic;
  if (encoding == "sRGB" || encoding == "srgb") return TextureEncoding::srgb;
  if (encoding == "linear") return TextureEncoding::linear;
  if (!encoding.starts_with("gamma"))
    fail(list.place_of("encoding"), "unknown encoding \"" + encoding + "\"; use sRGB or linear");
  build.warn(list.place_of("encoding"), "the encoding \"" + encoding + "\" is not supported; sRGB is used");
  return TextureEncoding::srgb;
}

WrapMode read_wrap(Build& build, ParameterList& list) {
  const std::string wrap = list.string("wrap", "repeat");
  if (wrap == "repeat") return WrapMode::repeat;
  if (wrap == "black") return WrapMode::black;
  if (wrap == "clamp") return WrapMode::clamp;
  if (wrap != "octahedralsphere")
    fail(list.place_of("wrap"), "unknown wrap mode \"" + wrap + "\"; use repeat, black or clamp");
  build.warn(list.place_of("wrap"), "the wrap mode \"octahedralsphere\" is not supported; clamp is used");
  return WrapMode::clamp;
}

/// All filters but the first are interpolated, also between sizes of the picture where it is seen from afar.
bool read_nearest(ParameterList& list) {
  const std::string filter = list.string("filter", "bilinear");
  if (filter == "point") return true;
  if (filter != "bilinear" && filter != "trilinear" && filter != "ewa" && filter != "EWA")
    fail(list.place_of("filter"), "unknown filter \"" + filter + "\"; use point, bilinear, trilinear or ewa");
  return false;
}

uint32_t image_index(Build& build, ParameterList& list, TextureEncoding encoding, bool is_float) {
  const std::string name = list.string("filename", "");
  const InputPath path = build.existing_file(list.place_of("filename"), name);
  const auto [entry, is_new] = build.images_by_key.try_emplace({path.name, static_cast<int>(encoding), is_float}, 0u);
  if (is_new) {
    ImageTexels image = read_texture(path, encoding);
    if (is_float) make_grey(image);
    entry->second = static_cast<uint32_t>(build.scene.images.size());
    build.scene.images.push_back(std::move(image));
  }
  return entry->second;
}

}  // namespace

void read_image_texture(Build& build, ParameterList& list, bool is_float, Texture& texture) {
  texture.kind = TextureKind::image;
  texture.wrap = read_wrap(build, list);
  texture.nearest = read_nearest(list);
  texture.image_scale = list.number("scale", 1);
  texture.invert = list.boolean("invert", false);
  list.ignore({"maxanisotropy"});
  texture.image = image_index(build, list, read_encoding(build, list), is_float);
}

}  // namespace alhazen::pbrt
