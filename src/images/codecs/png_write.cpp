// Writes 8-bit PNG by libpng.

#include <png.h>

#include <algorithm>
#include <csetjmp>

#include "files/atomic_file.h"
#include "images/display/display_row.h"
#include "images/image.h"

namespace alhazen {

namespace {

/// libpng reports errors by longjmp. Each method here sets the jump and only calls libpng, and has no object with a
/// destructor in its frame; no C++ exception passes through libpng's frames.
class PngWriter {
 public:
  PngWriter(const std::string& path, AtomicFile& file) : path_(path), file_(file) {}
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void begin(int width, int height) { require(try_begin(width, height)); }
  void write_row(const std::vector<uint8_t>& row) { require(try_write_row(row.data())); }
  void end() { require(try_end()); }

 private:
  bool try_begin(int width, int height) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) return false;
    png_set_write_fn(png_, this, on_write, on_flush);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
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
    if (file_.failed()) file_.commit();  // throws the failure of the disk
    throw RenderError("cannot write " + path_ + ": " + (message_[0] != '\0' ? message_ : "not enough memory"));
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
      file_.write(data, size);
      return true;
    } catch (const RenderError&) {
      return false;  // the file remembers the cause
    }
  }

  const std::string& path_;
  AtomicFile& file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[256] = {};
};

}  // namespace

void write_png(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  const std::array<size_t, 3> channels = rgb_channels(path, source);
  AtomicFile file(path);
  PngWriter writer(path, file);
  writer.begin(source.width, source.height);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint8_t> encoded(3 * width);
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    encode_display_row(row, channels, options, encoded);
    writer.write_row(encoded);
  }
  writer.end();
  file.commit();
}

}  // namespace alhazen
