#pragma once

// Texts of scene files and places in them. Every error of the reader goes through `fail`.

#include <memory>
#include <optional>
#include <string>

#include "files/byte_source.h"
#include "util/diagnostics.h"

namespace alhazen::pbrt {

/// A text with the name that it has in messages: a file, which is streamed and looked into again for the excerpt of an
/// error, or a text in memory.
struct SourceFile {
  std::string name;
  std::optional<InputPath> file;  ///< absent: `text` is the text
  std::string text;

  /// The bytes from the start, decompressed where the file is gzip data. Throws InputError.
  std::unique_ptr<ByteSource> open() const;
};

/// Where something stands. Lines and columns (in bytes) count from 1.
struct Place {
  std::shared_ptr<const SourceFile> source;
  int line = 0;
  int column = 0;

  SourceLocation location() const;
};

/// The error with the place, the message and the line with a caret below the place. It reads the file up to there, so
/// it is made only where it is thrown.
InputError error_at(const Place& place, const std::string& message);
/// Throws it.
[[noreturn]] void fail(const Place& place, const std::string& message);

}  // namespace alhazen::pbrt
