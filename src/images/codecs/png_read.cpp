// Reads PNG of every depth and colour type by libpng.

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <utility>

#include "images/codecs/decoders.h"
#include "images/codecs/image_bytes.h"

namespace alhazen::impl {

namespace {

/// libpng reports errors by longjmp. Each method that sets the jump only calls libpng, and has no object with a
/// destructor in its frame.
class PngReader {
 public:
  explicit PngReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool read_header() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) return false;
    png_set_read_fn(png_, this, on_read);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png_, info_);
    return true;
  }

  int64_t width() const { return png_get_image_width(png_, info_); }
  int64_t height() const { return png_get_image_height(png_, info_); }
  uint64_t packed_row_bytes() const { return png_get_rowbytes(png_, info_); }
  bool has_16_bits() const { return png_get_bit_depth(png_, info_) == 16; }
  bool has_alpha() const {
    return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0 ||
           png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
  }

  /// Palettes and small depths are expanded, grey is tripled, alpha is kept or dropped: three or four samples per
  /// texel, big-endian if they have 16 bits.
  bool start(bool with_alpha, size_t expected_row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_palette_to_rgb(png_);
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_gray_to_rgb(png_);
    if (with_alpha)
      png_set_tRNS_to_alpha(png_);
    else
      png_set_strip_alpha(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    if (png_get_rowbytes(png_, info_) != expected_row_bytes) png_error(png_, "unexpected size of a row");
    return true;
  }

  /// Reads to the end of the file, so that truncation is detected too.
  bool read_rows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  const char* message() const { return message_[0] != '\0' ? message_ : "not enough memory"; }

 private:
  static void on_error(png_structp png, png_const_charp message) {
    auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::copy_n(message, std::min(std::strlen(message), sizeof(message_) - 1), reader->message_);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  static void on_read(png_structp png, png_bytep data, size_t size) {
    auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->bytes_.size()) png_error(png, "the file is truncated");
    std::memcpy(data, reader->bytes_.data(), size);
    reader->bytes_ = reader->bytes_.subspan(size);
  }

  std::span<const uint8_t> bytes_;  ///< not yet read
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[256] = {};
};

std::vector<float> decode_samples(const std::vector<uint8_t>& samples, bool srgb) {
  std::vector<float> values(samples.size() / 2);
  for (size_t i = 0; i < values.size(); ++i) {
    const double value = (samples[2 * i] * 256 + samples[2 * i + 1]) / 65535.0;
    values[i] = static_cast<float>(srgb ? srgb_decode(value) : value);
  }
  return values;
}

struct Samples {
  int width = 0, height = 0;
  bool has_16_bits = false;
  std::vector<uint8_t> bytes;  ///< empty if alpha was requested and the file has none
};

Samples read_samples(const std::string& path, std::span<const uint8_t> bytes, bool with_alpha) {
  PngReader reader(bytes);
  const auto require = [&](bool succeeded) {
    if (!succeeded) throw_malformed(path, std::string("not a readable PNG file: ") + reader.message());
  };
  require(reader.read_header());
  if (with_alpha && !reader.has_alpha()) return {};
  const int64_t width = reader.width(), height = reader.height();
  check_size(path, width, height);
  check_plausible(path, reader.packed_row_bytes() * static_cast<uint64_t>(height), bytes.size());
  const size_t row_bytes = static_cast<size_t>(width) * (with_alpha ? 4 : 3) * (reader.has_16_bits() ? 2 : 1);
  Samples samples{static_cast<int>(width), static_cast<int>(height), reader.has_16_bits(), {}};
  samples.bytes.resize(row_bytes * static_cast<size_t>(height));
  std::vector<png_bytep> rows(static_cast<size_t>(height));
  for (size_t y = 0; y < rows.size(); ++y) rows[y] = samples.bytes.data() + y * row_bytes;
  require(reader.start(with_alpha, row_bytes));
  require(reader.read_rows(rows.data()));
  return samples;
}

}  // namespace

ImageTexels decode_png(const std::string& path, std::span<const uint8_t> bytes, bool decode_16_bit) {
  Samples samples = read_samples(path, bytes, false);
  ImageTexels texels{samples.width, samples.height, {}, {}, true, path};
  if (samples.has_16_bits)
    texels.floats = decode_samples(samples.bytes, decode_16_bit);
  else
    texels.bytes = std::move(samples.bytes);
  return texels;
}

std::optional<ImageTexels> decode_png_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  Samples samples = read_samples(path, bytes, true);
  if (samples.bytes.empty()) return std::nullopt;
  const size_t size = samples.has_16_bits ? 2 : 1, count = samples.bytes.size() / (4 * size);
  for (size_t i = 0; i < count; ++i)
    for (size_t k = 0; k < size; ++k) samples.bytes[i * size + k] = samples.bytes[(4 * i + 3) * size + k];
  samples.bytes.resize(count * size);
  ImageTexels texels{samples.width, samples.height, {}, {}, false, path, 1};
  if (samples.has_16_bits)
    texels.floats = decode_samples(samples.bytes, false);
  else
    texels.bytes = std::move(samples.bytes);
  return unless_opaque(std::move(texels));
}

}  // namespace alhazen::impl
