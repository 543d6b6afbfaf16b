#include "render/backend.h"

#include <algorithm>

namespace alhazen {

std::vector<std::unique_ptr<Backend>> all_backends() {
  std::vector<std::unique_ptr<Backend>> backends;
  backends.push_back(make_serial_backend());
  backends.push_back(make_openmp_backend());
  return backends;
}

std::unique_ptr<Backend> make_backend(const std::string& name) {
  std::string names;
  for (std::unique_ptr<Backend>& backend : all_backends()) {
    const BackendDescription description = backend->describe();
    if (description.name == name) {
      if (!description.available)
        throw InputError("the backend '" + name + "' is not available: " + description.details);
      return std::move(backend);
    }
    names += ", " + description.name;
  }
  throw InputError("unknown backend '" + name + "': it may be auto" + names);
}

void choose_backend(const Settings& asked, RenderSettings& settings) {
  settings.backend = asked.backend == "auto" ? (settings.threads > 1 ? "openmp" : "serial") : asked.backend;
  const BackendDescription backend = make_backend(settings.backend)->describe();
  if (settings.backend == "serial") settings.threads = 1;
  if (asked.strategy == "auto" || asked.strategy.empty()) {
    settings.strategy = backend.strategies.empty() ? "" : backend.strategies.front();
    return;
  }
  if (std::find(backend.strategies.begin(), backend.strategies.end(), asked.strategy) == backend.strategies.end()) {
    std::string choices;
    for (const std::string& strategy : backend.strategies) choices += ", " + strategy;
    throw InputError("the backend '" + settings.backend + "' has no strategy '" + asked.strategy +
                     "': " + (choices.empty() ? "it takes none" : "it may be auto" + choices));
  }
  settings.strategy = asked.strategy;
}

}  // namespace alhazen
