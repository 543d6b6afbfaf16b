#pragma once

// Texts of scene files and locations in them. Every error of the reader is thrown by `fail`.

#include <memory>
#include <optional>
#include <string>

#include "files/byte_source.h"
#include "util/diagnostics.h"

namespace alhazen::impl::pbrt {

/// A text with its name in messages: a file, which is streamed and read again for the excerpt of an error, or a text in
/// memory.
struct SourceFile {
  std::string name;
  std::optional<InputPath> file;  ///< absent: `text` is the text
  std::string text;

  /// The bytes from the start, decompressed if the file is gzip data. Throws InputError.
  std::unique_ptr<ByteSource> open() const;
};

/// A location in a file. Lines and columns (in bytes) count from 1.
struct Place {
  std::shared_ptr<const SourceFile> source;
  int line = 0;
  int column = 0;

  SourceLocation location() const;
};

/// Makes the error with the location, the message and the line with a caret below the location. It reads the file up to
/// there, so it is called only to throw.
InputError error_at(const Place& place, const std::string& message);
/// Throws it.
[[noreturn]] void fail(const Place& place, const std::string& message);

}  // namespace alhazen::impl::pbrt
