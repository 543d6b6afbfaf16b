#include "util/diagnostics.h"

#include "util/printable.h"

namespace alhazen::impl {

std::string SourceLocation::to_string() const {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  if (line > 0 && column > 0) text += ":" + std::to_string(column);
  return text;
}

static std::string located(const SourceLocation& where, const std::string& message) {
  const std::string place = where.to_string();
  return printable(place.empty() ? message : place + ": " + message);
}

InputError::InputError(const SourceLocation& where, const std::string& message, const std::string& excerpt)
    : alhazen::InputError(located(where, message) + (excerpt.empty() ? "" : "\n" + printable_lines(excerpt)),
                          printable(message), where.file, where.line, where.column) {}

InputError::InputError(const std::string& message) : alhazen::InputError(printable(message)) {}

RenderError::RenderError(const std::string& message) : Error(printable_lines(message)) {}

std::string Diagnostics::Warning::to_string() const { return located(where, message); }

void Diagnostics::warn(const SourceLocation& where, const std::string& message) {
  if (seen_.insert(message).second) warnings_.push_back({where, message});
}

}  // namespace alhazen::impl
