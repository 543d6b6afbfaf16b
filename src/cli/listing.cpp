#include "cli/listing.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "io/read_scene.h"
#include "util/printable.h"

namespace alhazen::impl {

static ReadOptions reading(const Settings& settings) {
  ReadOptions choice;
  choice.confine = settings.confine;
  choice.definitions = settings.definitions;
  choice.search = {settings.search_paths, settings.strict};
  return choice;
}

SceneListing list_choices(const std::string& scene, const Settings& settings) {
  if (!offers_choices(scene, reading(settings))) return {};
  Diagnostics diagnostics;
  return list_scene(scene, reading(settings), diagnostics);
}

void print_listing(const std::string& scene, const Settings& settings, bool as_json) {
  Diagnostics diagnostics;
  const SceneListing listing = list_scene(scene, reading(settings), diagnostics);
  const std::pair<const char*, const std::vector<std::string>*> kinds[] = {{"cameras", &listing.cameras},
                                                                           {"variants", &listing.variants},
                                                                           {"animations", &listing.animations},
                                                                           {"lights", &listing.lights}};
  nlohmann::ordered_json json;
  for (const auto& [kind, names] : kinds) {
    json[kind] = *names;
    if (as_json) continue;
    print_out("{}: {}\n", kind, names->size());
    for (size_t i = 0; i < names->size(); ++i) print_out("  {} {}\n", i, printable((*names)[i]));
  }
  // Names are bytes of the file and need not be valid UTF-8.
  if (as_json) print_out("{}\n", json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
}

}  // namespace alhazen::impl
