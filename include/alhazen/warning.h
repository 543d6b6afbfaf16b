#pragma once

// What the library warns of: something in a file or a setting that is replaced or has no effect, while work goes on.

#include <string>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

struct Warning {
  std::string message{};     ///< without the place
  std::string file{};        ///< that it is about; empty if it is about none
  int line = 0, column = 0;  ///< in `file`, counted from 1; 0: unknown
  std::string text() const;  ///< `file:line:column: message`, as one line that is safe to print on a terminal
  friend bool operator==(const Warning&, const Warning&) = default;
};

}  // namespace ALHAZEN_NAMESPACE
