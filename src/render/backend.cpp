#include "render/backend.h"

#include <algorithm>

namespace alhazen::impl {

namespace {

/// The names of the backends of GPUs: "cuda or optix".
std::string backends_of_devices() {
  std::string names;
  for (const std::unique_ptr<Backend>& backend : all_backends()) {
    const BackendTraits traits = backend->traits();
    if (traits.runs_on_devices) names += (names.empty() ? "" : " or ") + traits.name;
  }
  return names;
}

}  // namespace

std::unique_ptr<Backend> make_backend(const std::string& name) {
  std::string names;
  for (std::unique_ptr<Backend>& backend : all_backends()) {
    const std::string own = backend->traits().name;
    if (own == name) return std::move(backend);
    names += ", " + own;
  }
  throw InputError("unknown backend '" + name + "': it may be auto" + names);
}

void Backend::configure(const Settings& asked, RenderSettings&) const {
  if (!asked.device.empty())
    throw InputError("the backend '" + traits().name + "' has no devices to choose from: leave out '" + asked.device +
                     "', or use the backend " + backends_of_devices());
  refuse_blocks(asked);
  require_available();
}

std::vector<NamedSetting> Backend::named_settings(const RenderSettings& settings) const {
  return {{"schedule", to_string(settings.schedule)}};
}

void Backend::require_available() const {
  const BackendStatus here = status();
  if (!here.available) throw UnsupportedError("the backend '" + traits().name + "' is not available: " + here.details);
}

void Backend::refuse_blocks(const Settings& asked) const {
  if (!asked.block.empty())
    throw InputError("the backend '" + traits().name + "' takes no block size: leave out '" + asked.block + "'");
  if (!asked.chunk.empty())
    throw InputError("the backend '" + traits().name + "' takes no number of chunks: leave out '" + asked.chunk + "'");
}

void Backend::refuse_schedule(const Settings& asked) const {
  if (!asked.schedule.empty())
    throw InputError("the backend '" + traits().name + "' takes no schedule: leave out '" + asked.schedule + "'");
}

uint32_t parse_strategy(const BackendTraits& backend, const std::string& name) {
  if (name == "auto" || name.empty()) return 0;
  const auto found = std::find(backend.strategies.begin(), backend.strategies.end(), name);
  if (found != backend.strategies.end()) return static_cast<uint32_t>(found - backend.strategies.begin());
  std::string choices;
  for (const std::string& strategy : backend.strategies) choices += ", " + strategy;
  throw InputError("the backend '" + backend.name + "' has no strategy '" + name +
                   "': " + (choices.empty() ? "it takes none" : "it may be auto" + choices));
}

std::string strategy_name(const RenderSettings& settings) {
  const std::vector<std::string> names = make_backend(settings.backend)->traits().strategies;
  return names.empty() ? "" : names.at(settings.strategy);
}

void choose_backend(const Settings& asked, RenderSettings& settings) {
  settings.backend = asked.backend == "auto" ? default_backend(settings.threads) : asked.backend;
  const std::unique_ptr<Backend> backend = make_backend(settings.backend);
  const BackendTraits traits = backend->traits();
  settings.strategy = parse_strategy(traits, asked.strategy);
  if (settings.precision != Precision::single && !traits.traces_double)
    throw InputError("the backend '" + traits.name +
                     "' traces rays in float: use --precision float, or another backend");
  backend->configure(asked, settings);
}

}  // namespace alhazen::impl
