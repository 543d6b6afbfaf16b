#include "util/diagnostics.h"

#include "util/log.h"
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

UnsupportedError::UnsupportedError(const std::string& message) : alhazen::UnsupportedError(printable(message)) {}

TooLargeError::TooLargeError(const std::string& message) : OutOfMemoryError(printable(message)) {}
TooLargeError::TooLargeError(const SourceLocation& where, const std::string& message)
    : OutOfMemoryError(located(where, message)) {}

RenderError::RenderError(const std::string& message) : Error(printable_lines(message)) {}

std::string Diagnostics::Warning::to_string() const { return located(where, message); }

alhazen::Warning Diagnostics::Warning::to_public() const {
  return {printable(message), where.file, where.line, where.line > 0 ? where.column : 0};
}

void Diagnostics::warn(const SourceLocation& where, const std::string& message) {
  if (!seen_.insert(message).second) return;
  warnings_.push_back({where, message});
  if (is_logged()) log_line(LogLevel::warning, warnings_.back().to_string());
}

std::vector<alhazen::Warning> Diagnostics::public_warnings() const {
  std::vector<alhazen::Warning> list;
  for (const Warning& warning : warnings_) list.push_back(warning.to_public());
  return list;
}

}  // namespace alhazen::impl

namespace ALHAZEN_NAMESPACE {

std::string Warning::text() const { return impl::located({file, line, column}, message); }

}  // namespace ALHAZEN_NAMESPACE
