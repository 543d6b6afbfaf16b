// Writes EXR by OpenEXR's scanline interface, a block of rows at a time, so that a large image with many channels is
// never in memory as a whole.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "files/atomic_file.h"
#include "images/image.h"

namespace alhazen {

namespace {

/// A multiple of the 16 rows that ZIP compresses together.
constexpr int rows_per_block = 64;

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
  std::vector<char> block;  ///< rows_per_block rows of values of `type`
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

std::vector<ExrPlane> make_planes(const ImageSource& source, const WriteOptions& options) {
  std::vector<ExrPlane> planes;
  for (const std::string& channel : source.channels) {
    const bool single = options.pixel_type == ExrPixelType::single || is_always_single(channel, options);
    planes.push_back({channel, single ? Imf::FLOAT : Imf::HALF, {}});
    planes.back().block.resize(planes.back().value_size() * static_cast<size_t>(source.width) * rows_per_block);
  }
  return planes;
}

Imath::Box2i data_window(const ImageSource& source, const WriteOptions& options) {
  return {{options.x_offset, options.y_offset},
          {options.x_offset + source.width - 1, options.y_offset + source.height - 1}};
}

Imf::Header make_header(const ImageSource& source, const std::vector<ExrPlane>& planes, const WriteOptions& options) {
  const int full_width = options.full_width > 0 ? options.full_width : source.width;
  const int full_height = options.full_height > 0 ? options.full_height : source.height;
  Imf::Header header(Imath::Box2i({0, 0}, {full_width - 1, full_height - 1}), data_window(source, options));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ExrPlane& plane : planes) header.channels().insert(plane.channel, Imf::Channel(plane.type));
  Imf::addChromaticities(header, Imf::Chromaticities());  // those of sRGB
  for (const auto& [name, text] : options.metadata) header.insert(name, Imf::StringAttribute(text));
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

void write_block(Imf::OutputFile& output, const std::vector<ExrPlane>& planes, int count) {
  const Imath::Box2i& window = output.header().dataWindow();
  const Imath::V2i origin(window.min.x, output.currentScanLine());
  Imf::FrameBuffer frame;
  for (const ExrPlane& plane : planes)
    frame.insert(plane.channel, Imf::Slice::Make(plane.type, plane.block.data(), origin,
                                                 int64_t{window.max.x} - window.min.x + 1, rows_per_block));
  output.setFrameBuffer(frame);
  output.writePixels(count);
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
  std::vector<float> row(source.channels.size() * static_cast<size_t>(source.width));
  {
    auto output = guarded(
        path, file, [&] { return std::make_unique<Imf::OutputFile>(stream, make_header(source, planes, options)); });
    for (int y = 0; y < source.height; y += rows_per_block) {
      const int count = std::min(rows_per_block, source.height - y);
      fill_block(source, y, count, row, planes);
      guarded(path, file, [&] { write_block(*output, planes, count); });
    }
  }  // the destructor of the output writes its offset table
  file.commit();
}

}  // namespace alhazen
