#pragma once

#include <string>

namespace alhazen {

/// Prints what --camera, --variant and --animation may choose from, and the lights, of a scene file.
/// `confine`: read nothing outside its folder.
void print_listing(const std::string& scene, bool confine, bool as_json);

}  // namespace alhazen
