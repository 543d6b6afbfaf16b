#include "render/backend.h"

#include <algorithm>
#include <charconv>

namespace alhazen {

namespace {

void choose_strategy(const std::string& asked, const BackendDescription& backend, RenderSettings& settings) {
  if (asked == "auto" || asked.empty()) {
    settings.strategy = backend.strategies.empty() ? "" : backend.strategies.front();
    return;
  }
  if (std::find(backend.strategies.begin(), backend.strategies.end(), asked) == backend.strategies.end()) {
    std::string choices;
    for (const std::string& strategy : backend.strategies) choices += ", " + strategy;
    throw InputError("the backend '" + settings.backend + "' has no strategy '" + asked +
                     "': " + (choices.empty() ? "it takes none" : "it may be auto" + choices));
  }
  settings.strategy = asked;
}

int parse_device(const std::string& text, const BackendDescription& backend) {
  if (text == "host" && backend.runs_on_host) return host_device;
  if (!backend.available) throw InputError("the backend '" + backend.name + "' is not available: " + backend.details);
  if (text == "all") return all_devices;
  const int count = static_cast<int>(backend.devices.size());
  int device = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), device);
  if (error != std::errc() || end != text.data() + text.size() || device < 0 || device >= count)
    throw InputError("there is no device '" + text + "': it may be " + (backend.runs_on_host ? "host, " : "") +
                     "all or a number from 0 to " + std::to_string(count - 1) + "; 'alhazen devices' lists them");
  return device;
}

/// Which of the GPUs, and one line of statistics for each of them.
void choose_device(const Settings& asked, const BackendDescription& backend, RenderSettings& settings) {
  settings.runs_on_device = true;
  settings.device = parse_device(asked.device.empty() ? "0" : asked.device, backend);
  settings.threads = settings.device == all_devices ? static_cast<int>(backend.devices.size()) : 1;
  if (settings.integrator != IntegratorKind::path && settings.integrator != IntegratorKind::iterative)
    throw InputError("the backend '" + backend.name + "' has no integrator '" + to_string(settings.integrator) +
                     "', which calls itself: it may be path, iterative");
}

}  // namespace

std::vector<std::unique_ptr<Backend>> all_backends() {
  std::vector<std::unique_ptr<Backend>> backends;
  backends.push_back(make_serial_backend());
  backends.push_back(make_openmp_backend());
  backends.push_back(make_embree_backend());
  backends.push_back(make_cuda_backend());
  backends.push_back(make_optix_backend());
  return backends;
}

std::unique_ptr<Backend> make_backend(const std::string& name) {
  std::string names;
  for (std::unique_ptr<Backend>& backend : all_backends()) {
    const std::string own = backend->describe().name;
    if (own == name) return std::move(backend);
    names += ", " + own;
  }
  throw InputError("unknown backend '" + name + "': it may be auto" + names);
}

void choose_backend(const Settings& asked, RenderSettings& settings) {
  settings.backend = asked.backend == "auto" ? (settings.threads > 1 ? "openmp" : "serial") : asked.backend;
  const BackendDescription backend = make_backend(settings.backend)->describe();
  if (backend.runs_on_devices)
    choose_device(asked, backend, settings);
  else if (!asked.device.empty())
    throw InputError("the backend '" + settings.backend + "' has no devices to choose from: leave out '" +
                     asked.device + "', or use the backend cuda or optix");
  else if (!backend.available)
    throw InputError("the backend '" + settings.backend + "' is not available: " + backend.details);
  if (settings.precision != Precision::single && !backend.traces_double)
    throw InputError("the backend '" + backend.name +
                     "' traces rays in float: use --precision float, or the backend cuda");
  if (settings.backend == "serial") settings.threads = 1;
  choose_strategy(asked.strategy, backend, settings);
  if (!asked.block.empty() && settings.strategy != "pixel" && settings.strategy != "chunk")
    throw InputError("a block size is for the strategies pixel and chunk of the backend cuda");
  if (!asked.chunk.empty() && settings.strategy != "chunk")
    throw InputError("a number of chunks is for the strategy chunk of the backend cuda");
}

}  // namespace alhazen
