// Writes JPEG by libjpeg: baseline, with as many samples of chroma as of luma.

#include <cstdio>  // jpeglib.h needs it and does not include it

#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <cstdint>
#include <string>
#include <vector>

#include "files/atomic_file.h"
#include "images/display/display_transform.h"
#include "images/image.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

/// libjpeg reports errors by a function that must not return. As in PngWriter, each method that sets the jump only
/// calls libjpeg and has no object with a destructor in its frame; no C++ exception passes through libjpeg's frames.
class JpegWriter {
 public:
  JpegWriter(const std::string& path, AtomicFile& file) : path_(path), file_(file) {
    compress_.err = jpeg_std_error(&errors_);
    errors_.error_exit = on_error;
    errors_.output_message = on_message;
    compress_.client_data = this;
    target_.init_destination = on_begin;
    target_.empty_output_buffer = on_full;
    target_.term_destination = on_end;
  }
  ~JpegWriter() { jpeg_destroy_compress(&compress_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  void begin(int width, int height, int quality) { require(try_begin(width, height, quality)); }
  void write_comment(const std::string& text) { require(try_write_comment(text.data(), text.size())); }
  void write_row(std::vector<uint8_t>& row) { require(try_write_row(row.data())); }
  void end() { require(try_end()); }

 private:
  bool try_begin(int width, int height, int quality) {
    if (setjmp(jump_) != 0) return false;
    jpeg_create_compress(&compress_);
    compress_.dest = &target_;
    compress_.image_width = static_cast<JDIMENSION>(width);
    compress_.image_height = static_cast<JDIMENSION>(height);
    compress_.input_components = 3;
    compress_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&compress_);
    jpeg_set_quality(&compress_, quality, TRUE);
    // libjpeg's default halves the resolution of chroma, which blurs the edges of saturated surfaces.
    compress_.comp_info[0].h_samp_factor = compress_.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&compress_, TRUE);
    return true;
  }

  bool try_write_comment(const char* text, size_t size) {
    if (setjmp(jump_) != 0) return false;
    jpeg_write_marker(&compress_, JPEG_COM, reinterpret_cast<const JOCTET*>(text), static_cast<unsigned>(size));
    return true;
  }

  bool try_write_row(uint8_t* row) {
    if (setjmp(jump_) != 0) return false;
    JSAMPROW rows[] = {row};
    jpeg_write_scanlines(&compress_, rows, 1);
    return true;
  }

  bool try_end() {
    if (setjmp(jump_) != 0) return false;
    jpeg_finish_compress(&compress_);
    return true;
  }

  void require(bool succeeded) const {
    if (succeeded) return;
    if (file_.failed()) file_.commit();  // throws the failure of the disk
    throw RenderError("cannot write " + path_ + ": " + message_.data());
  }

  static JpegWriter& writer_of(j_common_ptr compress) { return *static_cast<JpegWriter*>(compress->client_data); }
  static JpegWriter& writer_of(j_compress_ptr compress) { return *static_cast<JpegWriter*>(compress->client_data); }

  static void on_error(j_common_ptr compress) {
    JpegWriter& writer = writer_of(compress);
    compress->err->format_message(compress, writer.message_.data());
    std::longjmp(writer.jump_, 1);
  }
  static void on_message(j_common_ptr) {}

  static void on_begin(j_compress_ptr compress) { writer_of(compress).empty_buffer(); }
  static boolean on_full(j_compress_ptr compress) {
    JpegWriter& writer = writer_of(compress);
    if (!writer.flush(writer.buffer_.size())) on_error(reinterpret_cast<j_common_ptr>(compress));
    return TRUE;
  }
  static void on_end(j_compress_ptr compress) {
    JpegWriter& writer = writer_of(compress);
    if (!writer.flush(writer.buffer_.size() - writer.target_.free_in_buffer))
      on_error(reinterpret_cast<j_common_ptr>(compress));
  }

  void empty_buffer() {
    target_.next_output_byte = buffer_.data();
    target_.free_in_buffer = buffer_.size();
  }
  bool flush(size_t size) noexcept {
    empty_buffer();
    try {
      file_.write(buffer_.data(), size);
      return true;
    } catch (const RenderError&) {
      return false;  // the file remembers the cause
    }
  }

  const std::string& path_;
  AtomicFile& file_;
  jpeg_compress_struct compress_{};
  jpeg_error_mgr errors_{};
  jpeg_destination_mgr target_{};
  std::jmp_buf jump_{};
  std::array<char, JMSG_LENGTH_MAX> message_{};
  std::array<JOCTET, 65536> buffer_{};
};

/// One line for each text but the time that it took: equal images are equal files.
std::string comment_of(const std::map<std::string, std::string>& metadata) {
  std::string comment;
  for (const auto& [name, text] : metadata)
    if (name != "seconds") comment += (comment.empty() ? "" : "\n") + name + ": " + printable(text);
  constexpr size_t longest = 65533;
  return comment.substr(0, longest);
}

}  // namespace

void write_jpg(const std::string& path, const ImageSource& source, const WriteOptions& options) {
  const std::array<size_t, 3> channels = rgb_channels(path, source);
  if (source.width > max_jpeg_side || source.height > max_jpeg_side)
    throw RenderError("cannot write " + path + ": a JPEG has at most " + std::to_string(max_jpeg_side) +
                      " pixels in each direction");
  AtomicFile file(path);
  JpegWriter writer(path, file);
  writer.begin(source.width, source.height, options.jpeg_quality);
  if (const std::string comment = comment_of(options.metadata); !comment.empty()) writer.write_comment(comment);
  const DisplayTransform display(options);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint16_t> encoded(3 * width);
  std::vector<uint8_t> bytes(3 * width);
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    display.encode_row(row, channels, 255, encoded);
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(encoded[i]);
    writer.write_row(bytes);
  }
  writer.end();
  file.commit();
}

}  // namespace alhazen::impl
