// Reads EXR: every channel of one part, or of all parts, as float.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <tuple>

#include "images/codecs/byte_reader.h"
#include "images/codecs/decoders.h"
#include "images/codecs/image_bytes.h"

namespace alhazen::impl {

namespace {

class MemoryStream : public Imf::IStream {
 public:
  MemoryStream(const std::string& path, std::span<const uint8_t> bytes) : IStream(path.c_str()), in_(path, bytes) {}
  bool read(char to[], int count) override {
    const auto bytes = in_.take(static_cast<size_t>(count));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<uint8_t*>(to));
    return in_.remaining() > 0;
  }
  uint64_t tellg() override { return in_.position(); }
  void seekg(uint64_t position) override { in_.seek(position); }

 private:
  ByteReader in_;
};

void skip_text(ByteReader& in) {
  while (in.u8() != 0) {
  }
}

/// Checks the attributes of all headers. OpenEXR allocates the size that an attribute declares, up to 2 GiB, before it
/// detects the end of the file; such files are refused here.
void check_attributes(const std::string& path, std::span<const uint8_t> bytes) {
  ByteReader in(path, bytes);
  in.skip(4);  // the signature
  const bool many_parts = (in.u32() & 0x1000) != 0;
  const auto at_end_of_list = [&] { return bytes[in.position()] == 0; };
  do {
    for (; in.remaining() > 0 && !at_end_of_list(); in.skip(in.u32())) {
      skip_text(in);  // name
      skip_text(in);  // type
    }
    in.skip(1);
  } while (many_parts && in.remaining() > 0 && !at_end_of_list());
}

struct ExrChannel {
  std::string name;
  int x_sampling = 1, y_sampling = 1;  ///< subsampling: one value for this many pixels
};

/// Files hold channels in alphabetical order. Users and `Image` expect the base layer first, in the order R, G, B, A.
std::tuple<std::string, size_t, std::string> reading_order(const std::string& name) {
  const size_t dot = name.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string component = dot == std::string::npos ? name : name.substr(dot + 1);
  return {layer, std::min(std::string("RGBA").find(component), std::string("RGBA").size()), component};
}

std::vector<ExrChannel> channels_of(const Imf::Header& header) {
  std::vector<ExrChannel> channels;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    channels.push_back({c.name(), c.channel().xSampling, c.channel().ySampling});
  std::sort(channels.begin(), channels.end(),
            [](const ExrChannel& a, const ExrChannel& b) { return reading_order(a.name) < reading_order(b.name); });
  return channels;
}

/// Expands a subsampled channel, whose values are packed at the front of the plane, to all pixels by nearest neighbour.
/// It runs backward, so that no value is overwritten before its last use.
void spread(std::vector<float>& plane, int width, int height, const ExrChannel& channel) {
  const int columns = (width + channel.x_sampling - 1) / channel.x_sampling;
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x)
      plane[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
          plane[static_cast<size_t>(y / channel.y_sampling) * static_cast<size_t>(columns) +
                static_cast<size_t>(x / channel.x_sampling)];
}

std::optional<Chromaticities> chromaticities_of(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return std::nullopt;
  const Imf::Chromaticities& c = Imf::chromaticities(header);
  const auto point = [](const Imath::V2f& v) { return Vec2d{static_cast<double>(v.x), static_cast<double>(v.y)}; };
  return Chromaticities{point(c.red), point(c.green), point(c.blue), point(c.white)};
}

/// Refuses an image, or a tile of it, that the file cannot hold.
void check_header(const std::string& path, const Imf::Header& header, size_t channels, uint64_t file_size) {
  if (header.hasType() && Imf::isDeepData(header.type())) throw_malformed(path, "holds deep data; compile it first");
  if (channels == 0) throw_malformed(path, "the EXR file has no channels");
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  check_size(path, width, height);
  check_plausible(path, sizeof(float) * channels * static_cast<uint64_t>(width * height), file_size);
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tile = header.tileDescription();
  check_size(path, tile.xSize, tile.ySize);
  check_plausible(path, sizeof(float) * channels * tile.xSize * uint64_t{tile.ySize}, file_size);
}

/// Ranks a part by its contents: colours, a luminance, a single channel of any kind, several channels that are no
/// image, unsupported data.
int rank_of(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) return 0;
  Image image;
  for (const ExrChannel& channel : channels_of(header)) image.channels.push_back(channel.name);
  const ColourChannels channels = colour_channels(image);
  if (!channels) return 1;
  if (channels.rgb[0] != channels.rgb[1]) return 4;
  const std::string& name = image.channels[static_cast<size_t>(channels.rgb[0])];
  return name == "Y" || name.ends_with(".Y") ? 3 : 2;
}

/// The first part of the highest rank: of several images, such as a stereo pair, the first is the default.
int image_part(const Imf::MultiPartInputFile& file) {
  int best = 0;
  for (int part = 1; part < file.parts(); ++part)
    if (rank_of(file.header(part)) > rank_of(file.header(best))) best = part;
  return best;
}

/// Appends the channels of a part to `image`, whose size is that of the part.
void read_part(Imf::MultiPartInputFile& file, int number, const std::vector<ExrChannel>& channels, Image& image) {
  const Imath::Box2i window = file.header(number).dataWindow();
  const size_t first = image.planes.size();
  Imf::FrameBuffer frame;
  for (const ExrChannel& channel : channels) {
    image.planes.emplace_back(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    const size_t columns = static_cast<size_t>((image.width + channel.x_sampling - 1) / channel.x_sampling);
    frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, image.planes.back().data(), window, sizeof(float),
                                                columns * sizeof(float), channel.x_sampling, channel.y_sampling));
  }
  Imf::InputPart part(file, number);
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  for (size_t c = 0; c < channels.size(); ++c)
    if (channels[c].x_sampling > 1 || channels[c].y_sampling > 1)
      spread(image.planes[first + c], image.width, image.height, channels[c]);
}

/// The name of a channel beside those of other parts.
std::string layered_name(const Imf::Header& header, const std::string& channel) {
  const bool is_layered = channel.find('.') != std::string::npos || !header.hasName();
  return is_layered ? channel : header.name() + "." + channel;
}

void read_other_parts(const std::string& path, Imf::MultiPartInputFile& file, int image_part, uint64_t file_size,
                      Image& image) {
  for (int number = 0; number < file.parts(); ++number) {
    const Imf::Header& header = file.header(number);
    if (number == image_part || (header.hasType() && Imf::isDeepData(header.type()))) continue;
    if (header.dataWindow() != file.header(image_part).dataWindow()) continue;
    std::vector<ExrChannel> channels = channels_of(header);
    check_header(path, header, channels.size(), file_size);
    std::erase_if(channels,
                  [&](const ExrChannel& channel) { return image.channel(layered_name(header, channel.name)) >= 0; });
    for (const ExrChannel& channel : channels) image.channels.push_back(layered_name(header, channel.name));
    read_part(file, number, channels, image);
  }
}

Image read_image_parts(const std::string& path, std::span<const uint8_t> bytes, bool all_parts) {
  check_attributes(path, bytes);
  MemoryStream stream(path, bytes);
  Imf::MultiPartInputFile file(stream);
  const int number = image_part(file);
  const Imf::Header& header = file.header(number);
  const std::vector<ExrChannel> channels = channels_of(header);
  check_header(path, header, channels.size(), bytes.size());
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;

  Image image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  image.chromaticities = chromaticities_of(header);
  for (const ExrChannel& channel : channels) image.channels.push_back(channel.name);
  read_part(file, number, channels, image);
  if (all_parts) read_other_parts(path, file, number, bytes.size(), image);
  return image;
}

}  // namespace

Image read_exr(const InputPath& input, bool all_parts) {
  const std::string& path = input.name;
  try {
    return read_image_parts(path, read_bytes(input), all_parts);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw TooLargeError({path}, "is too large for the memory of this machine");
  } catch (const std::exception& error) {
    throw_malformed(path, std::string("not a readable EXR file: ") + error.what());
  }
}

}  // namespace alhazen::impl
