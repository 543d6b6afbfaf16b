#include "files/byte_source.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include "util/diagnostics.h"

namespace alhazen::impl {

size_t MemorySource::read(char* into, size_t capacity) {
  const size_t count = left_.copy(into, capacity);
  left_.remove_prefix(count);
  return count;
}

/// zlib prefixes its messages with a path of its own, "<fd:5>: "; our messages already have the name.
static std::string without_path(const std::string& message) {
  const size_t end = message.starts_with("<fd:") ? message.find(">: ") : std::string::npos;
  return end == std::string::npos ? message : message.substr(end + 3);
}

struct FileSource::Handle {
  gzFile file;
};

FileSource::FileSource(const InputFile& file) : path_(file.name()), size_(file.size()) {
  // gzclose closes the descriptor that zlib is given.
  const int descriptor = ::fcntl(file.descriptor(), F_DUPFD_CLOEXEC, 0);
  if (descriptor < 0) throw InputError({path_}, std::string("cannot be opened: ") + std::strerror(errno));
  const gzFile stream = gzdopen(descriptor, "rb");
  if (!stream) {
    ::close(descriptor);
    throw InputError({path_}, std::string("cannot be opened: ") + std::strerror(ENOMEM));
  }
  gzbuffer(stream, 1u << 16);
  handle_.reset(new Handle{stream});
}

FileSource::~FileSource() { gzclose(handle_->file); }

size_t FileSource::read(char* into, size_t capacity) {
  const unsigned request = static_cast<unsigned>(std::min<size_t>(capacity, 1u << 30));
  const int count = gzread(handle_->file, into, request);
  if (count > 0) return static_cast<size_t>(count);
  int status = Z_OK;
  const char* const message = gzerror(handle_->file, &status);
  if (status == Z_ERRNO) throw InputError({path_}, std::string("cannot be read: ") + std::strerror(errno));
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  // zlib reports a truncated compressed stream as the end of the file, with this status.
  if (status == Z_BUF_ERROR) throw InputError({path_}, "the compressed data end early; the file is truncated");
  if (count < 0) throw InputError({path_}, "the compressed data are damaged: " + without_path(message));
  return 0;
}

uint64_t FileSource::plausible_size() const {
  // Meshes are seldom compressed further than this; larger meshes grow as they are read.
  constexpr uint64_t compression = 20;
  return gzdirect(handle_->file) ? size_ : size_ * compression;
}

}  // namespace alhazen::impl
