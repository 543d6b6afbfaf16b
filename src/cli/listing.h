#pragma once

#include <string>

namespace alhazen {

/// Prints the choices for --camera, --variant and --animation, and the lights, of a scene file. `confine`: read no
/// files outside its folder.
void print_listing(const std::string& scene, bool confine, bool as_json);

}  // namespace alhazen
