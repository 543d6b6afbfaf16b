#pragma once

// Numbers of the command line that must lie in a range.

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace alhazen {

/// A check whose limits, `low` and `high` included, are told when they are broken, not in the help. Unlike CLI::Range
/// it takes no NaN, which is neither below nor above anything.
template <class Number>
CLI::Validator within(Number low, Number high) {
  const auto check = [low, high](std::string& text) {
    Number value{};
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    std::ostringstream problem;
    problem.precision(10);
    problem << "Value " << text << " not in range " << low << " to " << high;
    return problem.str();
  };
  return CLI::Validator(check, "");
}

}  // namespace alhazen
