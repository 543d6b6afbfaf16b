#include "alhazen/save.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

#include "api/arguments.h"
#include "api/caller_errors.h"
#include "api/rendered_image.h"
#include "colour/white_point.h"
#include "images/codecs/encode_png.h"
#include "images/image.h"
#include "pipeline/write_outputs.h"

namespace ALHAZEN_NAMESPACE {

namespace {

impl::ToneMap tone_map_of(ToneMapping mapping) {
  switch (mapping) {
    case ToneMapping::reinhard:
      return impl::ToneMap::reinhard;
    case ToneMapping::filmic:
      return impl::ToneMap::filmic;
    case ToneMapping::aces:
      return impl::ToneMap::aces;
    case ToneMapping::agx:
      return impl::ToneMap::agx;
    case ToneMapping::none:
      break;
  }
  return impl::ToneMap::none;
}

void check(const RenderedImage& image, const SaveOptions& options) {
  impl::check_planes(image, "image");
  if (image.full_width != 0 || image.full_height != 0) {
    const auto is_within = [](int64_t first, int64_t size, int64_t full) { return first >= 0 && first + size <= full; };
    if (!is_within(image.x, image.width, image.full_width) || !is_within(image.y, image.height, image.full_height))
      throw InputError("image: its pixels from x, y are not within full_width and full_height");
  }
  std::set<std::string> names;
  for (const std::string& name : image.channels)
    if (name.empty() || !names.insert(name).second)
      impl::refuse_argument("channels", name.empty() ? "has an empty name" : "has '" + name + "' twice");
  // 2^exposure must be a number of single precision.
  if (!(options.exposure >= -126 && options.exposure <= 127))
    throw InputError("exposure must be from -126 to 127 stops");
  if (static_cast<uint32_t>(options.tone_mapping) > static_cast<uint32_t>(ToneMapping::agx))
    throw InputError("tone_mapping is none of its values");
  if (options.white_temperature != 0 && !(options.white_temperature >= impl::min_white_temperature &&
                                          options.white_temperature <= impl::max_white_temperature))
    throw InputError("white_temperature must be 0, or from 1000 to 25000 kelvin");
  if (options.png_depth != 8 && options.png_depth != 16) throw InputError("png_depth must be 8 or 16");
  if (options.jpeg_quality < 1 || options.jpeg_quality > 100) throw InputError("jpeg_quality must be from 1 to 100");
}

/// Of an entry of the metadata: only EXR files have layers.
bool is_about_layers(const std::pair<const std::string, std::string>& entry) {
  return entry.first.starts_with("cryptomatte/") || entry.first == "object" || entry.first == "material";
}

impl::WriteOptions write_options(const RenderedImage& image, const std::string& file, const SaveOptions& options) {
  impl::WriteOptions how;
  how.pixel_type = options.single_precision ? impl::ExrPixelType::single : impl::ExrPixelType::half;
  how.exposure = options.exposure;
  how.white_temperature = options.white_temperature;
  how.tone_map = tone_map_of(options.tone_mapping);
  how.png_depth = options.png_depth;
  how.jpeg_quality = options.jpeg_quality;
  how.metadata = image.metadata;
  how.metadata["software"] = std::string("Alhazen ") + version();
  if (impl::extension_of(file) != "exr") std::erase_if(how.metadata, is_about_layers);
  if (impl::is_displayed_format(file)) how.metadata["display"] = impl::display_text(how);
  how.x_offset = image.full_width > 0 ? image.x : 0;
  how.y_offset = image.full_height > 0 ? image.y : 0;
  how.full_width = image.full_width;
  how.full_height = image.full_height;
  return how;
}

impl::ImageSource source_of(const RenderedImage& image) {
  const size_t width = static_cast<size_t>(image.width);
  return {image.width, image.height, image.channels, [&image, width](int y, std::span<float> row) {
            const auto begin = static_cast<std::ptrdiff_t>(static_cast<size_t>(y) * width);
            for (size_t c = 0; c < image.planes.size(); ++c)
              std::copy_n(image.planes[c].begin() + begin, width, row.begin() + static_cast<std::ptrdiff_t>(c * width));
          }};
}

}  // namespace

void save(const RenderedImage& image, const std::string& file, const SaveOptions& options) {
  if (!impl::has_written_extension(file))
    throw impl::InputError(
        {file}, "images are written as " + impl::written_extensions() + ": give a name that ends in one of them");
  check(image, options);
  impl::for_caller([&] { impl::write_image(file, source_of(image), write_options(image, file, options)); });
}

std::vector<uint8_t> encode_png(const RenderedImage& image, const SaveOptions& options) {
  check(image, options);
  std::vector<uint8_t> bytes;
  impl::for_caller([&] {
    impl::encode_png("an image as PNG", source_of(image), write_options(image, "image.png", options),
                     [&](const uint8_t* data, size_t size) { bytes.insert(bytes.end(), data, data + size); });
  });
  return bytes;
}

}  // namespace ALHAZEN_NAMESPACE
