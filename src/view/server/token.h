#pragma once

// The secret in the URL of a page: who does not know it can neither see nor change anything.

#include <string>
#include <string_view>

namespace alhazen::impl {

/// 128 bits from the system's generator, as 32 hexadecimal digits.
std::string random_token();

/// Takes the same time whatever the tokens have in common, so that it does not tell how much of a guess is right.
bool equal_tokens(std::string_view a, std::string_view b);

/// Whether it can be a part of a path in a URL as it is: letters, digits, '-' and '_', and at least one.
bool is_token(std::string_view text);

}  // namespace alhazen::impl
