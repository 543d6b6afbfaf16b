#pragma once

// Which types a variant can hold.

#include <type_traits>
#include <variant>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

template <class Type, class Variant>
inline constexpr bool is_alternative = false;
template <class Type, class... Kinds>
inline constexpr bool is_alternative<Type, std::variant<Kinds...>> = (std::is_same_v<Type, Kinds> || ...);

/// `Type`, without references and const, is one of the types that `Variant` can hold, not merely convertible to one.
template <class Type, class Variant>
concept AlternativeOf = is_alternative<std::remove_cvref_t<Type>, Variant>;

}  // namespace ALHAZEN_NAMESPACE
