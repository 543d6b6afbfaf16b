// `alhazen devices`: lists the backends and denoisers, and for unavailable ones why and what to do.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "alhazen/devices.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/subcommands.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

void print_table(const Devices& all) {
  for (const BackendInfo& backend : all.backends) {
    print_out("{:<8} {:<14} {}\n", backend.name, backend.available ? "available" : "not available", backend.details);
    for (size_t i = 0; i < backend.devices.size(); ++i) print_out("{:<8} device {:<7} {}\n", "", i, backend.devices[i]);
    if (!backend.strategies.empty())
      print_out("{:<8} {:<14} {}\n", "", "strategies", fmt::join(backend.strategies, ", "));
    if (!backend.module.empty()) print_out("{:<8} {:<14} {}\n", "", "module", printable(backend.module));
  }
  for (const DenoiserInfo& denoiser : all.denoisers)
    print_out("{:<8} {:<14} {}\n", "denoiser", denoiser.name,
              printable(denoiser.available ? denoiser.details : "not available: " + denoiser.details));
  print_out("{:<8} {:<14} {}\n", "kernels", "built for", fmt::join(all.instruction_sets, ", "));
}

void print_json(const Devices& all) {
  auto backends = nlohmann::ordered_json::array(), denoisers = nlohmann::ordered_json::array();
  for (const BackendInfo& backend : all.backends)
    backends.push_back({{"name", backend.name},
                        {"available", backend.available},
                        {"details", backend.details},
                        {"devices", backend.devices},
                        {"strategies", backend.strategies},
                        {"module", backend.module}});
  for (const DenoiserInfo& denoiser : all.denoisers)
    denoisers.push_back({{"name", denoiser.name}, {"available", denoiser.available}, {"details", denoiser.details}});
  const nlohmann::ordered_json listing{{"backends", backends}, {"denoisers", denoisers}};
  print_out("{}\n", listing.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void register_devices(Command& program) {
  Command command = program.add_subcommand("devices", "List the backends, their devices, and the denoisers");
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "One JSON object instead of the table");
  command.on_run([json] { *json ? print_json(devices()) : print_table(devices()); });
}

}  // namespace alhazen::impl
