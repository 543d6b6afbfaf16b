#pragma once

// Texts of scene files and places in them. Every error of the reader goes through `fail`.

#include <memory>
#include <string>

#include "scene/diagnostics.h"

namespace alhazen::pbrt {

/// A text with the name it has in messages. `text` is dropped once it is parsed, the name stays for later messages.
struct SourceFile {
  std::string name;
  std::string text;
};

/// Where something stands. Lines and columns (in bytes) count from 1.
struct Place {
  std::shared_ptr<const SourceFile> source;
  int line = 0;
  int column = 0;

  SourceLocation location() const;
};

/// The error with the place, the message and the line with a caret below the place.
InputError error_at(const Place& place, const std::string& message);
/// Throws it.
[[noreturn]] void fail(const Place& place, const std::string& message);

/// The whole of a file, decompressed where it is gzip data. Throws InputError that names `path`.
std::string read_text(const std::string& path);

}  // namespace alhazen::pbrt
