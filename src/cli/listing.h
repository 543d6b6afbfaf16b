#pragma once

#include <string>

#include "alhazen/alhazen.h"
#include "io/read_options.h"

namespace alhazen::impl {

/// The choices that a scene file offers, read as `settings` say (confined, search paths). Nothing for formats that
/// offer none.
SceneListing list_choices(const std::string& scene, const Settings& settings);

/// Prints the choices for --camera, --variant and --animation, and the lights.
void print_listing(const std::string& scene, const Settings& settings, bool as_json);

}  // namespace alhazen::impl
