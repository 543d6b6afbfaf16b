#pragma once

// Range checks for numbers on the command line.

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace alhazen {

/// A check with inclusive limits `low` and `high`, which appear in the error but not in the help. Unlike CLI::Range it
/// rejects NaN.
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
