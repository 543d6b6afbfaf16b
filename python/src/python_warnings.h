#pragma once

// Warnings of the library as warnings of Python.

#include <set>
#include <string>
#include <vector>

#include "bindings.h"

namespace alhazen::python {

/// Those of the library, each a text or a record of one.
template <class List>
std::vector<std::string> warning_texts(const List& warnings) {
  std::vector<std::string> texts;
  for (const auto& warning : warnings) {
    if constexpr (requires { warning.text(); })
      texts.push_back(warning.text());
    else
      texts.push_back(warning);
  }
  return texts;
}

/// The reverse, without the places.
template <class Warning>
void set_warnings(std::vector<Warning>& warnings, const std::vector<std::string>& texts) {
  warnings.clear();
  for (const std::string& text : texts) {
    if constexpr (requires(Warning warning) { warning.message; })
      warnings.emplace_back().message = text;
    else
      warnings.push_back(text);
  }
}

/// Issues each as an alhazen.AlhazenWarning of the line of Python that called. Throws error_already_set where the
/// filters of `warnings` make errors of them.
void issue_texts(const std::vector<std::string>& texts);

template <class List>
void issue_warnings(const List& warnings) {
  issue_texts(warning_texts(warnings));
}

/// The same for those that are not in `issued`, which then has them.
void issue_new_warnings(const std::vector<std::string>& texts, std::set<std::string>& issued);

void bind_warnings(py::module_& m);

}  // namespace alhazen::python
