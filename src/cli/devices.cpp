// `alhazen devices`: lists the backends, and for unavailable ones why and what to do.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "cli/subcommands.h"
#include "render/backend.h"
#include "util/printable.h"

namespace alhazen {

namespace {

void print_table() {
  for (const auto& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    const BackendStatus status = backend->status();
    print_out("{:<8} {:<14} {}\n", traits.name, status.available ? "available" : "not available", status.details);
    for (size_t i = 0; i < status.devices.size(); ++i) print_out("{:<8} device {:<7} {}\n", "", i, status.devices[i]);
    if (!traits.strategies.empty())
      print_out("{:<8} {:<14} {}\n", "", "strategies", fmt::join(traits.strategies, ", "));
    if (!status.module.empty()) print_out("{:<8} {:<14} {}\n", "", "module", printable(status.module));
  }
}

void print_json() {
  auto list = nlohmann::ordered_json::array();
  for (const auto& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    const BackendStatus status = backend->status();
    list.push_back({{"name", traits.name},
                    {"available", status.available},
                    {"details", status.details},
                    {"devices", status.devices},
                    {"strategies", traits.strategies},
                    {"module", status.module}});
  }
  print_out("{}\n", list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

CLI::App* register_devices(CLI::App& app) {
  CLI::App* command = app.add_subcommand("devices", "List the backends and their devices");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "One JSON array instead of the table");
  command->callback([json] { *json ? print_json() : print_table(); });
  return command;
}

}  // namespace alhazen
