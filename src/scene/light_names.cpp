#include "scene/light_names.h"

#include <map>

#include "util/printable.h"

namespace alhazen {

std::vector<std::string> light_names(const Scene& scene) {
  std::vector<std::string> names;
  std::map<std::string, size_t> counts;
  for (const Light& light : scene.lights) {
    const bool surrounds = light.kind == LightKind::constant_infinite || light.kind == LightKind::environment;
    const std::string kind = light_traits(light.kind).name;
    names.push_back(!light.name.empty() ? printable(light.name)
                    : surrounds         ? "environment"
                                        : kind + "." + std::to_string(++counts[kind]));
  }
  return names;
}

}  // namespace alhazen
