#pragma once

#include <string>

namespace alhazen {

/// Prints what --camera, --variant and --animation may choose from, and the lights, of a scene file.
void print_listing(const std::string& scene, bool as_json);

}  // namespace alhazen
