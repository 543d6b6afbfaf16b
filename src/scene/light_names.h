#pragma once

// The names by which light groups and reports know the lights of a scene.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace alhazen {

/// Of Scene::lights, in their order. All that surrounds the scene, whether an image or of one colour, is called
/// `environment`. What a file leaves without a name is called by its kind and a number: `point.1`.
std::vector<std::string> light_names(const Scene& scene);

}  // namespace alhazen
