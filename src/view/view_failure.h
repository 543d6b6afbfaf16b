#pragma once

#include <string>

namespace alhazen::impl {

/// What has ended a session: what it was given cannot be used, or anything else.
enum class ViewFailure { none, input, other };

/// The text that the program prints for the exception that is being handled, and its kind.
std::string text_of_error(ViewFailure* failure = nullptr);

}  // namespace alhazen::impl
