#pragma once

#include <string>

#include "alhazen/alhazen.h"

namespace alhazen {

/// Prints the choices for --camera, --variant and --animation, and the lights, of a scene file, which is read with the
/// definitions and the confinement of `settings`.
void print_listing(const std::string& scene, const Settings& settings, bool as_json);

}  // namespace alhazen
