// `alhazen devices`: lists the backends and denoisers, and for unavailable ones why and what to do.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/subcommands.h"
#include "render/backend.h"
#include "render/denoiser.h"
#include "render/sample_kernel.h"
#include "util/printable.h"

namespace alhazen::impl {

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
  for (const auto& denoiser : all_denoisers()) {
    const std::string problem = denoiser->problem();
    print_out("{:<8} {:<14} {}\n", "denoiser", denoiser->name(),
              printable(problem.empty() ? denoiser->details() : "not available: " + problem));
  }
  std::vector<std::string> sets;
  for (const InstructionSet set : built_instruction_sets()) sets.push_back(to_string(set));
  print_out("{:<8} {:<14} {}\n", "kernels", "built for", fmt::join(sets, ", "));
}

void print_json() {
  auto backends = nlohmann::ordered_json::array(), denoisers = nlohmann::ordered_json::array();
  for (const auto& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    const BackendStatus status = backend->status();
    backends.push_back({{"name", traits.name},
                        {"available", status.available},
                        {"details", status.details},
                        {"devices", status.devices},
                        {"strategies", traits.strategies},
                        {"module", status.module}});
  }
  for (const auto& denoiser : all_denoisers()) {
    const std::string problem = denoiser->problem();
    denoisers.push_back({{"name", denoiser->name()},
                         {"available", problem.empty()},
                         {"details", problem.empty() ? denoiser->details() : problem}});
  }
  const nlohmann::ordered_json listing{{"backends", backends}, {"denoisers", denoisers}};
  print_out("{}\n", listing.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void register_devices(Command& program) {
  Command command = program.add_subcommand("devices", "List the backends, their devices, and the denoisers");
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "One JSON object instead of the table");
  command.on_run([json] { *json ? print_json() : print_table(); });
}

}  // namespace alhazen::impl
