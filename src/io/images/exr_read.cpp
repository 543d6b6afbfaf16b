// EXR input: every channel of the first part, as float.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <tuple>

#include "io/images/decoders.h"
#include "io/images/input_file.h"

namespace alhazen {

namespace {

struct ExrChannel {
  std::string name;
  int x_sampling = 1, y_sampling = 1;  ///< every so many pixels there is a value
};

/// Files hold channels in the order of the alphabet. People and `Image` expect the base layer first and R, G, B, A.
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

/// Spreads the values of a subsampled channel, which stand packed at the front of the plane, over all pixels: nearest
/// value. From the end backward, so that no value is overwritten before its last use.
void spread(std::vector<float>& plane, int width, int height, const ExrChannel& channel) {
  const int columns = (width + channel.x_sampling - 1) / channel.x_sampling;
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x)
      plane[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
          plane[static_cast<size_t>(y / channel.y_sampling) * static_cast<size_t>(columns) +
                static_cast<size_t>(x / channel.x_sampling)];
}

Image read_part(const std::string& path, uint64_t file_size) {
  Imf::MultiPartInputFile file(path.c_str());
  const Imf::Header& header = file.header(0);
  if (header.hasType() && Imf::isDeepData(header.type())) throw_malformed(path, "holds deep data; flatten it first");
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  const std::vector<ExrChannel> channels = channels_of(header);
  if (channels.empty()) throw_malformed(path, "the EXR file has no channels");
  check_declared_size(path, width, height, static_cast<int64_t>(4 * channels.size()), file_size);

  Image image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  Imf::FrameBuffer frame;
  for (const ExrChannel& channel : channels) {
    image.channels.push_back(channel.name);
    image.planes.emplace_back(static_cast<size_t>(width * height));
    const size_t columns = static_cast<size_t>((width + channel.x_sampling - 1) / channel.x_sampling);
    frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, image.planes.back().data(), window, sizeof(float),
                                                columns * sizeof(float), channel.x_sampling, channel.y_sampling));
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  for (size_t c = 0; c < channels.size(); ++c)
    if (channels[c].x_sampling > 1 || channels[c].y_sampling > 1)
      spread(image.planes[c], image.width, image.height, channels[c]);
  return image;
}

}  // namespace

Image read_exr(const std::string& path) {
  const uint64_t file_size = checked_file_size(path);
  try {
    return read_part(path, file_size);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw_malformed(path, "is too large for the memory of this machine");
  } catch (const std::exception& error) {
    throw_malformed(path, std::string("not a readable EXR file: ") + error.what());
  }
}

}  // namespace alhazen
