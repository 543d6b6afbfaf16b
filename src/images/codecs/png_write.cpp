// Writes PNG of 8 or 16 bits by libpng.

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <exception>

#include "files/atomic_file.h"
#include "images/codecs/encode_png.h"
#include "images/display/display_transform.h"
#include "images/image.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

/// libpng reports errors by longjmp. Each method here sets the jump and only calls libpng, and has no object with a
/// destructor in its frame; no C++ exception passes through libpng's frames.
class PngWriter {
 public:
  PngWriter(const std::string& name, const PngSink& sink, const WriteOptions& options, bool has_alpha)
      : name_(name), sink_(sink), depth_(options.png_depth), has_alpha_(has_alpha) {
    for (const auto& [key, text] : options.metadata) add_text(key == "software" ? "Software" : key, text);
    for (const auto& [keyword, text] : texts_) chunks_.push_back(text_chunk(keyword, text));
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void begin(int width, int height) { require(try_begin(width, height)); }
  /// `row`: three values of each pixel, or four with alpha.
  void write_row(std::span<const uint16_t> row) {
    const size_t size = depth_ == 16 ? 2 : 1;
    bytes_.resize(size * row.size());
    for (size_t i = 0; i < row.size(); ++i) {
      if (depth_ == 16) bytes_[2 * i] = static_cast<uint8_t>(row[i] >> 8);  // the high byte comes first
      bytes_[size * i + size - 1] = static_cast<uint8_t>(row[i]);
    }
    require(try_write_row(bytes_.data()));
  }
  void end() { require(try_end()); }

 private:
  /// PNG has keywords of at most 79 bytes. How long the render took stays out: equal images are equal files.
  void add_text(const std::string& name, const std::string& text) {
    if (name != "seconds") texts_.emplace_back(name.substr(0, 79), printable(text));
  }

  /// UTF-8, without compression.
  static png_text text_chunk(const std::string& keyword, const std::string& text) {
    png_text chunk{};
    chunk.compression = PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(keyword.c_str());  // libpng copies all of it
    chunk.text = const_cast<char*>(text.c_str());
    chunk.itxt_length = text.size();
    chunk.lang = chunk.lang_key = nullptr;
    return chunk;
  }

  bool try_begin(int width, int height) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) return false;
    png_set_write_fn(png_, this, on_write, on_flush);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth_,
                 has_alpha_ ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(png_, info_, chunks_.data(), static_cast<int>(chunks_.size()));
    png_write_info(png_, info_);
    return true;
  }

  bool try_write_row(const uint8_t* row) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_write_row(png_, row);
    return true;
  }

  bool try_end() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_write_end(png_, nullptr);
    return true;
  }

  void require(bool succeeded) const {
    if (succeeded) return;
    if (failure_) std::rethrow_exception(failure_);
    throw RenderError("cannot write " + name_ + ": " + (message_[0] != '\0' ? message_ : "not enough memory"));
  }

  static void on_error(png_structp png, png_const_charp message) {
    auto* writer = static_cast<PngWriter*>(png_get_error_ptr(png));
    std::copy_n(message, std::min(std::char_traits<char>::length(message), sizeof(message_) - 1), writer->message_);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static void on_flush(png_structp) {}

  static void on_write(png_structp png, png_bytep data, size_t size) {
    if (!static_cast<PngWriter*>(png_get_io_ptr(png))->take(data, size)) png_error(png, "the write failed");
  }
  bool take(const uint8_t* data, size_t size) noexcept {
    try {
      sink_(data, size);
      return true;
    } catch (...) {
      failure_ = std::current_exception();
      return false;
    }
  }

  const std::string& name_;
  const PngSink& sink_;
  std::exception_ptr failure_;
  int depth_;
  bool has_alpha_;
  std::vector<std::pair<std::string, std::string>> texts_;
  std::vector<png_text> chunks_;
  std::vector<uint8_t> bytes_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[256] = {};
};

}  // namespace

void encode_png(const std::string& name, const ImageSource& source, const WriteOptions& options, const PngSink& sink) {
  const std::array<size_t, 3> channels = rgb_channels(name, source);
  const auto found = std::find(source.channels.begin(), source.channels.end(), "A");
  const bool has_alpha = found != source.channels.end();
  const size_t alpha = static_cast<size_t>(found - source.channels.begin());
  PngWriter writer(name, sink, options, has_alpha);
  writer.begin(source.width, source.height);
  const DisplayTransform display(options);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint16_t> encoded(3 * width), with_alpha(has_alpha ? 4 * width : 0);
  const unsigned largest = options.png_depth == 16 ? 65535 : 255;
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    if (has_alpha) make_straight(row, channels, alpha, width);
    display.encode_row(row, channels, largest, encoded);
    if (has_alpha) {
      for (size_t x = 0; x < width; ++x) {
        std::copy_n(&encoded[3 * x], 3, &with_alpha[4 * x]);
        const float value = std::clamp(row[alpha * width + x], 0.0f, 1.0f);
        with_alpha[4 * x + 3] = static_cast<uint16_t>(std::lround(value * static_cast<float>(largest)));
      }
      writer.write_row(with_alpha);
    } else {
      writer.write_row(encoded);
    }
  }
  writer.end();
}

void write_png(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  rgb_channels(path, source);  // before the file is made
  AtomicFile file(path);
  encode_png(path, source, options, [&](const uint8_t* data, size_t size) { file.write(data, size); });
  file.commit();
}

}  // namespace alhazen::impl
