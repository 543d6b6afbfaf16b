#pragma once

// The camera and the brightness of lights by settings instead of the scene's own.

#include "alhazen/alhazen.h"
#include "scene/scene.h"

namespace alhazen {

/// Places the camera and scales the lights as `asked` says. Throws InputError that names the setting.
void choose_view(const Settings& asked, Scene& scene);

}  // namespace alhazen
