// Writes EXR a block of rows at a time, so that a large image with many channels is never in memory as a whole.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputPart.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "files/atomic_file.h"
#include "images/image.h"

namespace alhazen::impl {

namespace {

class AtomicStream : public Imf::OStream {
 public:
  AtomicStream(AtomicFile& file, const std::string& path) : OStream(path.c_str()), file_(file) {}
  void write(const char bytes[], int count) override { file_.write(bytes, static_cast<size_t>(count)); }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

 private:
  AtomicFile& file_;
};

struct ExrPlane {
  std::string channel;
  Imf::PixelType type = Imf::HALF;
  std::vector<char> block;  ///< rows_per_block() rows of values of `type`
  size_t value_size() const { return type == Imf::HALF ? sizeof(half) : sizeof(float); }
};

/// Half floats end at 65504; larger values would become infinities, which no later step could undo.
half to_half(float value) {
  if (std::isnan(value)) return half(value);
  return half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX)));
}

bool is_always_single(const std::string& channel, const WriteOptions& options) {
  return std::any_of(options.always_single.begin(), options.always_single.end(),
                     [&](const std::string& prefix) { return channel.starts_with(prefix); });
}

bool is_colour(const std::string& channel) {
  return (channel == "R" || channel.ends_with(".R")) && !channel.starts_with("Crypto");
}

bool loses(ExrCompression compression) {
  return compression == ExrCompression::dwaa || compression == ExrCompression::dwab;
}

/// The number of rows that are in memory at a time: a row of tiles, or a multiple of the 32 rows that PIZ compresses
/// together and no fewer than DWAA's.
int rows_per_block(const WriteOptions& options) { return options.tile_size > 0 ? options.tile_size : 64; }

std::vector<ExrPlane> make_planes(const ImageSource& source, const WriteOptions& options) {
  std::vector<ExrPlane> planes;
  for (const std::string& channel : source.channels) {
    const bool single = options.pixel_type == ExrPixelType::single || is_always_single(channel, options);
    planes.push_back({channel, single ? Imf::FLOAT : Imf::HALF, {}});
    planes.back().block.resize(planes.back().value_size() * static_cast<size_t>(source.width) *
                               static_cast<size_t>(std::min(rows_per_block(options), source.height)));
  }
  return planes;
}

/// A part of the file: its name, and the planes in it, from `first` to before `last`.
struct ExrPart {
  std::string name;
  size_t first, last;
};

/// The layer of a channel, by which Cryptomatte's ranks are one.
std::string part_name(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot == std::string::npos) return "rgba";
  std::string layer = channel.substr(0, dot);
  if (layer.starts_with("Crypto"))
    while (layer.back() >= '0' && layer.back() <= '9') layer.pop_back();
  return layer;
}

std::vector<ExrPart> make_parts(const ImageSource& source, const WriteOptions& options) {
  std::vector<ExrPart> parts;
  for (size_t c = 0; c < source.channels.size(); ++c) {
    const std::string name = options.has_parts ? part_name(source.channels[c]) : "";
    if (parts.empty() || parts.back().name != name) parts.push_back({name, c, c});
    parts.back().last = c + 1;
  }
  return parts;
}

Imath::Box2i data_window(const ImageSource& source, const WriteOptions& options) {
  return {{options.x_offset, options.y_offset},
          {options.x_offset + source.width - 1, options.y_offset + source.height - 1}};
}

Imf::Compression compression_of(ExrCompression compression) {
  switch (compression) {
    case ExrCompression::none:
      return Imf::NO_COMPRESSION;
    case ExrCompression::rle:
      return Imf::RLE_COMPRESSION;
    case ExrCompression::zips:
      return Imf::ZIPS_COMPRESSION;
    case ExrCompression::zip:
      break;
    case ExrCompression::piz:
      return Imf::PIZ_COMPRESSION;
    case ExrCompression::dwaa:
      return Imf::DWAA_COMPRESSION;
    case ExrCompression::dwab:
      return Imf::DWAB_COMPRESSION;
  }
  return Imf::ZIP_COMPRESSION;
}

/// Returns whether an attribute belongs into the header of a part: names of objects and materials may be many, and are
/// with their layers alone.
bool is_about(const ExrPart& part, const std::string& attribute, const WriteOptions& options) {
  if (attribute == "object" || attribute == "material") return part.name == attribute;
  if (!attribute.starts_with("cryptomatte/")) return true;
  const auto layer = options.metadata.find(attribute.substr(0, attribute.rfind('/')) + "/name");
  return layer == options.metadata.end() || layer->second == part.name;
}

Imf::Header make_header(const ImageSource& source, const std::vector<ExrPlane>& planes, const ExrPart& part,
                        const WriteOptions& options) {
  const int full_width = options.full_width > 0 ? options.full_width : source.width;
  const int full_height = options.full_height > 0 ? options.full_height : source.height;
  Imf::Header header(Imath::Box2i({0, 0}, {full_width - 1, full_height - 1}), data_window(source, options));
  const bool keeps = options.has_parts && loses(options.compression) && !is_colour(planes[part.first].channel);
  header.compression() = compression_of(keeps ? ExrCompression::zip : options.compression);
  if (options.tile_size > 0) {
    const auto side = static_cast<unsigned>(options.tile_size);
    header.setTileDescription(Imf::TileDescription(side, side, Imf::ONE_LEVEL));
  }
  header.setType(options.tile_size > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  if (!part.name.empty()) header.setName(part.name);
  for (size_t c = part.first; c < part.last; ++c)
    header.channels().insert(planes[c].channel, Imf::Channel(planes[c].type));
  Imf::addChromaticities(header, Imf::Chromaticities());  // those of sRGB
  for (const auto& [name, text] : options.metadata)
    if (part.name.empty() || is_about(part, name, options)) header.insert(name, Imf::StringAttribute(text));
  return header;
}

void store_row(std::span<const float> values, ExrPlane& plane, int row_in_block) {
  const size_t first = values.size() * static_cast<size_t>(row_in_block);
  if (plane.type == Imf::HALF)
    std::transform(values.begin(), values.end(), reinterpret_cast<half*>(plane.block.data()) + first, to_half);
  else
    std::copy(values.begin(), values.end(), reinterpret_cast<float*>(plane.block.data()) + first);
}

/// Gets rows y to y + count - 1 from the source.
void fill_block(const ImageSource& source, int y, int count, std::vector<float>& row, std::vector<ExrPlane>& planes) {
  const size_t width = static_cast<size_t>(source.width);
  for (int i = 0; i < count; ++i) {
    source.fill_row(y + i, row);
    for (size_t c = 0; c < planes.size(); ++c)
      store_row(std::span<const float>(row).subspan(c * width, width), planes[c], i);
  }
}

/// Writes `count` rows from row `y` of the image, which is a whole row of tiles if there are tiles.
void write_block(Imf::MultiPartOutputFile& file, int number, const ExrPart& part, const std::vector<ExrPlane>& planes,
                 int y, int count, const WriteOptions& options) {
  const Imath::Box2i& window = file.header(number).dataWindow();
  Imf::FrameBuffer frame;
  for (size_t c = part.first; c < part.last; ++c)
    frame.insert(planes[c].channel,
                 Imf::Slice::Make(planes[c].type, planes[c].block.data(), Imath::V2i(window.min.x, window.min.y + y),
                                  int64_t{window.max.x} - window.min.x + 1, rows_per_block(options)));
  if (options.tile_size > 0) {
    Imf::TiledOutputPart tiles(file, number);
    tiles.setFrameBuffer(frame);
    const int row = y / options.tile_size;
    tiles.writeTiles(0, tiles.numXTiles() - 1, row, row);
  } else {
    Imf::OutputPart rows(file, number);
    rows.setFrameBuffer(frame);
    rows.writePixels(count);
  }
}

void check_source(const std::string& path, const ImageSource& source) {
  const std::string failure = "cannot write " + path + ": ";
  if (source.width <= 0 || source.height <= 0) throw RenderError(failure + "the image has no pixels");
  if (source.channels.empty()) throw RenderError(failure + "the image has no channels");
  const std::set<std::string> names(source.channels.begin(), source.channels.end());
  if (names.size() != source.channels.size()) throw RenderError(failure + "two channels have the same name");
}

/// Runs a step of the library and converts its exceptions to RenderError; the disk's own failure takes precedence.
template <class Step>
auto guarded(const std::string& path, AtomicFile& file, const Step& step) {
  try {
    return step();
  } catch (const RenderError&) {
    throw;
  } catch (const std::exception& error) {
    if (file.failed()) file.commit();  // throws the first failure
    throw RenderError("cannot write " + path + ": " + error.what());
  }
}

}  // namespace

void write_exr(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  check_source(path, source);
  AtomicFile file(path);
  AtomicStream stream(file, path);
  std::vector<ExrPlane> planes = make_planes(source, options);
  const std::vector<ExrPart> parts = make_parts(source, options);
  std::vector<float> row(source.channels.size() * static_cast<size_t>(source.width));
  {
    auto output = guarded(path, file, [&] {
      std::vector<Imf::Header> headers;
      for (const ExrPart& part : parts) headers.push_back(make_header(source, planes, part, options));
      return std::make_unique<Imf::MultiPartOutputFile>(stream, headers.data(), static_cast<int>(headers.size()));
    });
    for (int y = 0; y < source.height; y += rows_per_block(options)) {
      const int count = std::min(rows_per_block(options), source.height - y);
      fill_block(source, y, count, row, planes);
      for (size_t p = 0; p < parts.size(); ++p)
        guarded(path, file, [&] { write_block(*output, static_cast<int>(p), parts[p], planes, y, count, options); });
    }
  }  // the destructor of the output writes its offset table
  file.commit();
}

}  // namespace alhazen::impl
