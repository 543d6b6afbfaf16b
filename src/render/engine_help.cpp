#include "render/engine_help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/backend.h"

namespace alhazen::impl {

std::string backend_help() {
  std::string text = "auto (the result of 'alhazen study tune', else the CPU)";
  for (const auto& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    text += fmt::format(", {} ({})", traits.name, traits.help);
  }
  return text + "; 'alhazen devices' lists them";
}

std::string strategy_help() {
  std::string text = "auto";
  std::vector<std::string> before;
  for (const auto& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    if (traits.strategies.empty()) continue;
    if (traits.strategies == before)
      text += fmt::format("; {}: the same", traits.name);
    else
      text += fmt::format("; {}: {}", traits.name, fmt::join(traits.strategies, ", "));
    before = traits.strategies;
  }
  return text;
}

}  // namespace alhazen::impl
