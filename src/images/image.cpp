#include "images/image.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>

#include "images/codecs/decoders.h"
#include "images/read_texture.h"

namespace alhazen::impl {

int Image::channel(const std::string& name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

ImageSource source_of(const Image& image) {
  const auto fill_row = [&image](int y, std::span<float> row) {
    const size_t width = static_cast<size_t>(image.width);
    for (size_t c = 0; c < image.planes.size(); ++c)
      std::copy_n(image.planes[c].begin() + static_cast<std::ptrdiff_t>(width) * y, width,
                  row.begin() + static_cast<std::ptrdiff_t>(c * width));
  };
  return {image.width, image.height, image.channels, fill_row};
}

Image image_of(const ImageSource& source, const std::function<bool(const std::string&)>& keeps) {
  Image image{source.width, source.height, {}, {}};
  std::vector<size_t> kept;
  for (size_t channel = 0; channel < source.channels.size(); ++channel) {
    if (keeps && !keeps(source.channels[channel])) continue;
    kept.push_back(channel);
    image.channels.push_back(source.channels[channel]);
  }
  const size_t width = static_cast<size_t>(source.width);
  image.planes.assign(kept.size(), std::vector<float>(width * static_cast<size_t>(source.height)));
  std::vector<float> row(width * source.channels.size());
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    for (size_t i = 0; i < kept.size(); ++i)
      std::copy_n(row.begin() + static_cast<ptrdiff_t>(kept[i] * width), width,
                  image.planes[i].begin() + static_cast<ptrdiff_t>(static_cast<size_t>(y) * width));
  }
  return image;
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

namespace {

struct WrittenFormat {
  const char* extension;
  void (*write)(const std::string&, const ImageSource&, const WriteOptions&);
};

constexpr WrittenFormat written_formats[] = {
#define ALHAZEN_WRITTEN_FORMAT(name) {#name, write_##name},
    ALHAZEN_WRITTEN_FORMATS(ALHAZEN_WRITTEN_FORMAT)
#undef ALHAZEN_WRITTEN_FORMAT
};

const WrittenFormat* written_format(const std::string& path) {
  std::string extension = extension_of(path);
  if (extension == "jpeg") extension = "jpg";
  const auto* format = std::find_if(std::begin(written_formats), std::end(written_formats),
                                    [&](const WrittenFormat& f) { return extension == f.extension; });
  return format == std::end(written_formats) ? nullptr : format;
}

}  // namespace

void write_image(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  const WrittenFormat* format = written_format(path);
  if (format == nullptr) throw RenderError("cannot write " + path + ": its name must end in " + written_extensions());
  format->write(path, source, options);
}

bool is_displayed_format(const std::string& path) {
  const WrittenFormat* format = written_format(path);
  return format != nullptr && (format->write == write_png || format->write == write_jpg);
}

bool has_written_extension(const std::string& path) { return written_format(path) != nullptr; }

std::string written_extensions() {
  constexpr size_t count = std::size(written_formats);
  std::string text;
  for (size_t i = 0; i < count; ++i)
    text += (i == 0 ? "." : i + 1 < count ? ", ." : " or .") + std::string(written_formats[i].extension);
  return text;
}

std::array<size_t, 3> rgb_channels(const std::string& path, const ImageSource& source) {
  if (source.width <= 0 || source.height <= 0) throw RenderError("cannot write " + path + ": the image has no pixels");
  const auto position = [&](const char* name) {
    const auto found = std::find(source.channels.begin(), source.channels.end(), name);
    if (found == source.channels.end())
      throw RenderError("cannot write " + path + ": the image has no channel " + name);
    return static_cast<size_t>(found - source.channels.begin());
  };
  return {position("R"), position("G"), position("B")};
}

namespace {

float linear_value(const ImageTexels& texels, size_t i) {
  if (texels.bytes.empty()) return texels.floats[i];
  const double value = texels.bytes[i] / 255.0;
  return static_cast<float>(texels.srgb ? srgb_decode(value) : value);
}

}  // namespace

Image read_image(const InputPath& path) {
  if (image_format(path) == ImageFormat::exr) return read_exr(path, true);
  const ImageTexels texels = read_texture(path, TextureEncoding::automatic);
  Image image{texels.width, texels.height, {"R", "G", "B"}, {}};
  const size_t count = static_cast<size_t>(texels.width) * static_cast<size_t>(texels.height);
  image.planes.assign(3, std::vector<float>(count));
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < 3; ++c) image.planes[c][i] = linear_value(texels, 3 * i + c);
  return image;
}

}  // namespace alhazen::impl
