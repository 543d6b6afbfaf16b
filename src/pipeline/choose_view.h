#pragma once

// The camera and the brightness of lights by settings instead of the scene's own.

#include "alhazen/alhazen.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen {

/// Places the camera, and turns and scales the lights as `asked` says; warns of what has no effect. Throws InputError
/// that names the setting.
void choose_view(const Settings& asked, Scene& scene, Diagnostics& diagnostics);

}  // namespace alhazen
