#pragma once

// Other cameras in a compiled scene.

#include <string>

#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Gives a scene that was compiled for several cameras another one, for images of that size: nothing is read or built
/// again. `camera` is in the world, also where the scene is in another render space. `scene_name` is for messages.
template <class Real>
void change_camera(Camera camera, const std::string& scene_name, int64_t width, int64_t height, int threads,
                   CompiledScene<Real>& scene);

}  // namespace alhazen::impl
