#pragma once

// XML texts as trees of elements, each with its location.

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/byte_source.h"
#include "util/diagnostics.h"

namespace alhazen::impl::mitsuba {

/// A text with its name in messages.
struct SourceText {
  std::string name;
  std::string text;
};

/// What a scene may still take, with the files that it includes: small files may include others many times.
struct XmlBudget {
  size_t bytes = size_t{1} << 30;
  size_t elements = 10'000'000;
};

/// Reads a whole text, decompressed if it is gzip data. Throws InputError, also if the budget does not suffice.
std::shared_ptr<const SourceText> read_text(const InputPath& path, XmlBudget& budget);

/// A location in a text: the start of an element. Lines and columns (in bytes) count from 1.
struct Place {
  std::shared_ptr<const SourceText> source;
  int line = 0;
  int column = 0;

  SourceLocation location() const { return {source ? source->name : std::string(), line, column}; }
};

/// Throws InputError with the location, the message and the line with a caret below the location.
[[noreturn]] void fail(const Place& place, const std::string& message);

struct Element {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;
  Place place;

  /// Null if there is no attribute of that name.
  const std::string* find(std::string_view name) const;
};

/// Whether this build has the XML parser.
bool reads_xml();

/// Returns the root element. Throws InputError with the location: text that is not well-formed XML, text between
/// elements, a document type declaration (and with it all entities but the five of XML), elements nested over 128 deep,
/// more elements than the budget has.
Element parse_xml(const std::shared_ptr<const SourceText>& source, XmlBudget& budget);

}  // namespace alhazen::impl::mitsuba
