#include "alhazen/error.h"

namespace ALHAZEN_NAMESPACE {

Error::Error(const std::string& message) : std::runtime_error(message) {}

InputError::InputError(const std::string& message)
    : Error(message), place_(std::make_shared<const Place>(Place{message, {}, 0, 0})) {}

InputError::InputError(const std::string& what, const std::string& message, const std::string& file, int line,
                       int column)
    : Error(what), place_(std::make_shared<const Place>(Place{message, file, line, column})) {}

}  // namespace ALHAZEN_NAMESPACE
